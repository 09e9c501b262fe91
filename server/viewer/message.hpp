#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "server/deformation/deformation.hpp"

/// The messages of docs/viewer-protocol.md, in both directions. Pure.
namespace irdm::viewer {

inline constexpr std::uint16_t kVersion = 1;
inline constexpr double kCoarsestUnit = 1e-5;  ///< of a quantised displacement [m]
inline constexpr std::size_t kMaxNameLength = 256;
inline constexpr std::size_t kMaxTokenLength = 128;

using Bytes = std::vector<std::uint8_t>;

/// The bytes are not a message of this protocol.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One object of a Scene.
struct SceneObject {
  std::string name;     ///< UTF-8, cut to kMaxNameLength bytes
  Points rest;          ///< X (n, 3) [m], B; single precision on the wire
  Triangles triangles;  ///< (t, 3), outward
  float mass = 0;       ///< [kg]
  float stiffness = 0;  ///< Young's modulus [Pa]
};

/// What does not change while the server runs.
struct Scene {
  double dt = 0.0;  ///< [s]
  bool lockstep = false;
  std::optional<FloorConfig> floor;  ///< without its friction on the wire
  std::vector<SimulationStylus> styluses;
  std::vector<SceneObject> objects;
};

/// Median, 99th percentile and maximum [us]; NaN: not measured.
struct Percentiles {
  float p50 = std::numeric_limits<float>::quiet_NaN();
  float p99 = std::numeric_limits<float>::quiet_NaN();
  float max = std::numeric_limits<float>::quiet_NaN();
};

/// How the run goes. Counts are since the start.
struct Health {
  std::uint64_t steps = 0;
  Percentiles step_time = {};     ///< of the last second
  Percentiles wakeup_delay = {};  ///< of the last second; not in lockstep
  std::uint64_t missed = 0;       ///< deadlines
  std::uint64_t unsolved = 0;
  std::uint64_t resets = 0;
  std::uint64_t lost_steps = 0;  ///< by the deformation
  float surface_rate = 0;        ///< [1/s]
  std::uint32_t viewers = 0;
  std::uint64_t sessions = 0;
  std::uint64_t samples = 0;
  std::uint64_t forces = 0;
  std::uint64_t forces_replaced = 0;
  std::uint64_t protocol_errors = 0;
};

/// The first message of a viewer.
struct Hello {
  std::string token = {};
};

enum class CommandKind : std::uint16_t { kPutBack = 1 };

/// What a viewer asks for.
struct Command {
  CommandKind kind = CommandKind::kPutBack;
};

using ClientMessage = std::variant<Hello, Command>;

Bytes encode(const Scene& scene);
/// Replaces what is in `bytes`, whose memory is used again. Displacements are rounded to at most
/// half of kCoarsestUnit.
void encode(const SurfaceFrame& frame, Bytes& bytes);
Bytes encode(const Health& health);
Bytes encode(const ClientMessage& message);

/// These throw MessageError, and nothing else, whatever the bytes are.
Scene decode_scene(std::span<const std::uint8_t> bytes);
/// @param nodes surface nodes of each object, from the Scene
SurfaceFrame decode_frame(std::span<const std::uint8_t> bytes, std::span<const std::size_t> nodes);
Health decode_health(std::span<const std::uint8_t> bytes);
ClientMessage decode_client(std::span<const std::uint8_t> bytes);

}  // namespace irdm::viewer
