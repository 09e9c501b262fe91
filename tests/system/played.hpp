#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/hdf5/file.hpp"
#include "common/model/model_file.hpp"
#include "scene/scene.hpp"
#include "tests/support/catch.hpp"
#include "tests/system/penetration.hpp"
#include "tests/system/stage.hpp"

namespace irdm::test {

/// The trace of a scene that was played to its end.
class Played {
 public:
  /// @param bridge its configuration's name; empty: as the scene's
  explicit Played(const std::string& scene, const std::string& bridge = "");

  std::size_t rows() const { return rows_; }
  double dt() const { return dt_; }
  const SceneConfig& scene() const { return config_; }
  /// The row at whose end it is `time` [s].
  std::size_t row(double time) const {
    return static_cast<std::size_t>(std::lround(time / dt_)) - 1;
  }
  Vector3 vector(const std::string& set, std::size_t k) {
    std::vector<double>& values = vectors_[set];
    if (values.empty()) values = file_->read<double>(set, {rows_, 3});
    return Vector3(values.data() + 3 * k);
  }
  Vector3 position(std::size_t k) { return vector("/step/body_position", k); }
  Vector3 force(std::size_t k, int stylus = 0) {
    return vector("/stylus/" + std::to_string(stylus) + "/force", k);
  }
  Vector3 tip(std::size_t k, int stylus = 0) {
    return vector("/stylus/" + std::to_string(stylus) + "/tip", k);
  }
  Quaternion orientation(std::size_t k) {
    std::vector<double>& wxyz = vectors_["/step/body_orientation"];
    if (wxyz.empty()) wxyz = file_->read<double>("/step/body_orientation", {rows_, 4});
    return {wxyz[4 * k], wxyz[4 * k + 1], wxyz[4 * k + 2], wxyz[4 * k + 3]};
  }
  std::vector<std::uint8_t> flags(const std::string& set) const {
    return file_->read<std::uint8_t>(set, {rows_});
  }
  double mass(std::size_t object = 0) const { return model(object).body.mass; }
  Model model(std::size_t object = 0) const {
    return read_model(config_.objects[object].model, ResponseKind::kModal);
  }
  /// Sum of the forces on the object by another one, or by scenery i (-1 - i), in step k [N], W.
  Vector3 body_force(std::size_t k, int object, int other);
  /// Of a floating object alone: mass times acceleration in step k, less all forces on it [N], W.
  /// Damping acts at both ends of a step, half of it each.
  Vector3 unbalanced(std::size_t k);
  /// Sum of the floor's forces on the object in step k [N], W.
  Vector3 floor_force(std::size_t k);
  /// Where the stylus touches its surface at rest in step k [m], B.
  Vector3 contact_at_rest(std::size_t k, int stylus, const Model& model);
  double peak_force(int stylus = 0);
  /// The deepest surface node of an object inside another one, scenery or floor, of all steps.
  NodeInside deepest_node() const;

 private:
  struct Touch {
    int object;
    int other;
    Vector3 force;
  };

  void read_body_contacts();

  Stage stage_;
  SceneConfig config_;
  double mass_ = 0.0;                         ///< of the first object [kg]
  std::vector<std::vector<Touch>> touching_;  ///< of each step
  std::unique_ptr<hdf5::File> file_;
  std::size_t rows_ = 0;
  double dt_ = 0.0;
  std::map<std::string, std::vector<double>> vectors_;
  std::map<int, std::vector<std::int32_t>> contact_nodes_;
};

/// No surface node is ever more than 0.5 mm inside something else.
void check_penetration(const Played& played);

}  // namespace irdm::test
