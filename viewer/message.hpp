#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "common/model/display_mesh.hpp"
#include "simulation/deformation/deformation.hpp"

/// The messages of docs/viewer-protocol.md, in both directions. Pure.
namespace irdm::viewer {

inline constexpr std::uint16_t kVersion = 1;
inline constexpr double kCoarsestUnit = 1e-5;  ///< of a quantised displacement [m]
inline constexpr std::size_t kMaxNameLength = 256;
inline constexpr std::size_t kMaxTokenLength = 128;
inline constexpr std::size_t kMaxRecordingName = 64;
inline constexpr std::size_t kMaxRecordings = 100;
inline constexpr std::size_t kMaxSaves = 100;   ///< of settings as a scene, by one server
inline constexpr std::size_t kMaxScenes = 200;  ///< to choose from
inline constexpr std::size_t kMaxSceneName = 128;
inline constexpr std::size_t kMaxNotice = 512;
inline constexpr double kFarthest = 1000.0;             ///< of a tip, in each direction [m]
inline constexpr std::size_t kMaxRegions = 64;          ///< of an object that are listed
inline constexpr std::size_t kMaxRegionFaces = 20'000;  ///< inside an object

using Bytes = std::vector<std::uint8_t>;

/// The bytes are not a message of this protocol.
class MessageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Least and greatest value of a region's elements.
struct Span {
  float lowest = 0;
  float highest = 0;  ///< not below the lowest
};

/// What a region of an object is made of.
struct SceneRegion {
  std::uint32_t number = 0;  ///< of the [[region]], from 1; 0: what is in none
  Span youngs_modulus = {};  ///< [Pa]
  Span poisson_ratio = {};
  Span density = {};  ///< [kg/m^3]
};

/// The regions of a soft object of several materials: t triangles of its surface, q faces inside.
struct SceneRegions {
  std::vector<SceneRegion> regions = {};    ///< by number; none: the object is of one material
  bool some_unlisted = false;               ///< there are more than kMaxRegions
  bool faces_left_out = false;              ///< there are more than kMaxRegionFaces
  std::vector<float> surface_modulus = {};  ///< (t) Young's modulus [Pa]; NaN: not known
  /// Faces between tetrahedra of different regions, as corners of them.
  Points nodes = Points(0, 3);           ///< (p, 3) at rest [m], B; single precision on the wire
  Triangles faces = Triangles(0, 3);     ///< (q, 3), into nodes, outward of the later region
  std::vector<float> face_modulus = {};  ///< (q) of the later region [Pa]

  bool empty() const { return regions.empty(); }
};

/// One object of a Scene.
struct SceneObject {
  std::string name;     ///< UTF-8, cut to kMaxNameLength bytes
  Points rest;          ///< X (n, 3) [m], B; single precision on the wire
  Triangles triangles;  ///< (t, 3), outward
  float mass = 0;       ///< [kg]
  float stiffness = 0;  ///< Young's modulus [Pa]
  /// Static, along the normal, per node as the middle of a fingertip [m/N]; NaN: not known.
  std::vector<float> compliance = {};
  SceneRegions regions = {};
  DisplayMesh display = {};  ///< empty: the surface itself is drawn
};

/// What does not change while the server runs.
struct Scene {
  double dt = 0.0;  ///< [s]
  bool lockstep = false;
  std::optional<FloorConfig> floor;    ///< without its friction on the wire
  std::vector<SceneryConfig> scenery;  ///< the same
  std::vector<SimulationStylus> styluses;
  bool viewer_stylus = false;  ///< the last of them is the viewers'
  float max_force = 0;         ///< with which that one pushes [N]
  bool recorded = false;       ///< there is no live run
  std::vector<SceneObject> objects;
};

/// Median, 99th percentile and maximum [us]; NaN: not measured.
struct Percentiles {
  float p50 = std::numeric_limits<float>::quiet_NaN();
  float p99 = std::numeric_limits<float>::quiet_NaN();
  float max = std::numeric_limits<float>::quiet_NaN();
};

/// What one stylus' bridge measured within a second [us].
struct LinkHealth {
  bool reported = false;  ///< else the rest means nothing
  Percentiles round_trip = {};
  Percentiles age = {};  ///< of the force that is felt
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
  std::vector<LinkHealth> links = {};  ///< per stylus of a bridge
};

/// A recording that can be played.
struct RecordingName {
  std::uint16_t number = 0;
  std::string name;  ///< UTF-8, cut to kMaxRecordingName bytes

  bool operator==(const RecordingName&) const = default;
};

/// What can change while the server runs.
struct State {
  static constexpr std::uint16_t kNone = 0xFFFF;
  bool looks_on = false;      ///< this viewer's requests are not carried out
  bool stylus_free = false;   ///< the viewers' one
  bool holds_stylus = false;  ///< this viewer has it
  bool paused = false;
  bool recording = false;
  bool playback = false;  ///< a recorded run is shown
  bool playing = false;   ///< ... and is not paused
  bool can_record = false;
  bool has_scenes = false;  ///< there is a folder of them; else the next two are false
  bool can_load = false;    ///< another one may take the place of this run
  bool preparing = false;   ///< one is being loaded or saved
  std::uint32_t settings_changes = 0;
  double length = 0.0;  ///< of the recorded run that is shown [s]
  double speed = 1.0;
  std::uint16_t shown = kNone;  ///< number of the recording that is shown
  std::vector<RecordingName> recordings = {};
  std::vector<std::string> scenes = {};  ///< UTF-8, cut to kMaxSceneName bytes
  std::uint16_t scene = kNone;           ///< number of the one that runs
  std::string notice = {};               ///< UTF-8, cut to kMaxNotice bytes
  Settings settings = {};
  std::vector<SettingsChoice> choices = {};  ///< per object

  bool operator==(const State&) const = default;
};

/// The first message of a viewer.
struct Hello {
  std::string token = {};
  bool looks_on = false;  ///< it asks for no more than that
};

enum class CommandKind : std::uint16_t {
  kReset = 1,
  kPause = 2,
  kResume = 3,
  kStep = 4,  ///< number
  kRecord = 5,
  kEndRecording = 6,
  kShowRecording = 7,  ///< number
  kShowLive = 8,
  kPlay = 9,
  kPausePlayback = 10,
  kSeek = 11,      ///< value [s]
  kSetSpeed = 12,  ///< value
  kSaveScene = 13,
};

/// What a viewer asks for.
struct Command {
  CommandKind kind = CommandKind::kReset;
  std::uint16_t number = 0;
  double value = 0.0;
};

/// Where a viewer's stylus is to be.
struct StylusRequest {
  bool present = false;
  std::uint32_t buttons = 0;
  Vector3 tip = Vector3::Zero();  ///< [m], W
};

/// All settings of a scene of so many objects.
struct SettingsRequest {
  Settings settings = {};
  std::size_t objects = 0;
};

/// The scene that a viewer wants to see in place of this one.
struct SceneRequest {
  std::string name = {};  ///< from the list in State: 1 to kMaxSceneName bytes
};

using ClientMessage = std::variant<Hello, Command, StylusRequest, SettingsRequest, SceneRequest>;

Bytes encode(const Scene& scene);
/// Replaces what is in `bytes`, whose memory is used again. Displacements are rounded to at most
/// half of kCoarsestUnit.
void encode(const SurfaceFrame& frame, Bytes& bytes);
Bytes encode(const Health& health);
Bytes encode(const State& state);
Bytes encode(const ClientMessage& message);

/// These throw MessageError, and nothing else, whatever the bytes are.
Scene decode_scene(std::span<const std::uint8_t> bytes);
/// @param nodes surface nodes of each object, from the Scene
SurfaceFrame decode_frame(std::span<const std::uint8_t> bytes, std::span<const std::size_t> nodes);
State decode_state(std::span<const std::uint8_t> bytes, std::size_t objects);
Health decode_health(std::span<const std::uint8_t> bytes);
ClientMessage decode_client(std::span<const std::uint8_t> bytes);

}  // namespace irdm::viewer
