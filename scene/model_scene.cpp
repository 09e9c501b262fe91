#include "scene/model_scene.hpp"

#include <toml++/toml.h>
#include <algorithm>
#include <mutex>
#include <numbers>
#include <sstream>

#include "common/dense_algebra.hpp"
#include "common/hdf5/handle.hpp"
#include "common/model/model_file.hpp"

namespace irdm {
namespace {

constexpr double kCoupling = 300.0;       // [N/m]
constexpr double kTetherFrequency = 3.0;  // of the object on it [Hz]
constexpr double kTetherDamping = 5.0;    // [1/s]
constexpr double kSlowestPerStep = 0.25;  // of frequency and damping, times dt

struct Described {
  Model model;
  const char* engine;
};

Described describe(const std::filesystem::path& path) {
  const std::lock_guard lock(hdf5::library_mutex());
  const hdf5::File file = hdf5::File::open(path);
  const char* engine = "compressed";
  if (file.exists("/response/dense")) engine = "dense";
  if (file.exists("/response/modal")) engine = "modal";
  Described described{read_description(hdf5::File::open(path)), engine};
  if (is_rigid(described.model)) described.engine = "modal";
  return described;
}

toml::table pair(const char* first, double value, const char* second, double other) {
  toml::table table{{first, value}, {second, other}};
  table.is_inline(true);
  return table;
}

void add_tether(const Model& model, toml::table& object) {
  const double bound = kSlowestPerStep / model.dt;
  const double frequency = std::min(2.0 * std::numbers::pi * kTetherFrequency, bound);
  const double damping = std::min(kTetherDamping, bound);
  const double inertia = symmetric_eigenvalues(model.body.inertia)(0);
  const double square = frequency * frequency;
  object.insert("tether",
                pair("stiffness", model.body.mass * square, "angular_stiffness", inertia * square));
  object.insert("damping", pair("linear", damping, "angular", damping));
}

}  // namespace

SceneSource model_scene(const std::filesystem::path& path) {
  const Described described = describe(path);
  toml::table object{{"name", path.stem().string()},
                     {"model", path.filename().string()},
                     {"engine", described.engine}};
  if (described.model.body.support == Support::kFloating) add_tether(described.model, object);
  const toml::table scene{{"contact", toml::table{{"coupling_stiffness", kCoupling}}},
                          {"object", toml::array{object}}};
  std::ostringstream text;
  text << scene << '\n';
  return {path.string(), text.str(), std::filesystem::absolute(path).parent_path()};
}

}  // namespace irdm
