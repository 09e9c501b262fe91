#pragma once

#include <cstdint>
#include <string>

#include "server/scene_loader.hpp"
#include "viewer/message.hpp"

namespace irdm {

/// What viewers see and ask of a folder of scenes. Viewer's thread.
class SceneChoice {
 public:
  /// @param run that is under way @param refusal why no other one can take its place; empty: it can
  /// All must outlive this object.
  SceneChoice(SceneLoader& loader, const PreparedRun& run, std::string refusal);

  /// A scene is being loaded or saved.
  bool preparing() { return loader_.busy(); }
  /// Throw Error where that is not possible.
  void load(const std::string& name);
  void save(const Settings& settings);

  /// Fills in what a State says of scenes. What came of a request goes into `notice`.
  void report(viewer::State& state, std::string& notice);

 private:
  void expect_idle();

  SceneLoader& loader_;
  const PreparedRun& run_;
  std::string refusal_;
  std::uint64_t told_;  ///< requests whose outcome has been told
};

}  // namespace irdm
