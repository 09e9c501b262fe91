#include "server/viewer_session/scene_choice.hpp"

#include <algorithm>

#include "common/error.hpp"
#include "scene/scene_folder.hpp"

namespace irdm {

static_assert(kMostScenes == viewer::kMaxScenes && kLongestSceneName == viewer::kMaxSceneName);

SceneChoice::SceneChoice(SceneLoader& loader, const PreparedRun& run, std::string refusal)
    : loader_(loader), run_(run), refusal_(std::move(refusal)), told_(loader.status().done) {}

void SceneChoice::expect_idle() {
  if (!loader_.possible()) {
    throw Error("scenes", "have no folder", "set viewer.scenes or start with --scenes");
  }
  if (loader_.busy()) throw Error("scenes", "are busy with another request", "wait for its end");
}

void SceneChoice::load(const std::string& name) {
  expect_idle();
  if (!refusal_.empty())
    throw Error(shortened(name), "cannot be loaded: " + refusal_, "start anew");
  const std::vector<std::string>& names = loader_.status().names;
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw Error(shortened(name), "is not among the scenes any more", "choose another one");
  }
  loader_.load(name);
}

void SceneChoice::save(const Settings& settings) {
  expect_idle();
  if (loader_.saves() >= viewer::kMaxSaves) {
    throw Error("settings", "were saved " + std::to_string(loader_.saves()) + " times already",
                "start the server again to save more");
  }
  loader_.save(run_.source, initial_settings(run_.config), settings);
}

void SceneChoice::report(viewer::State& state, std::string& notice) {
  if (!loader_.possible()) return;
  state.preparing = loader_.busy();
  const SceneLoaderStatus& status = loader_.status();
  if (status.done != told_) {
    told_ = status.done;
    if (!status.notice.empty()) notice = status.notice;
  }
  state.has_scenes = true;
  state.can_load = refusal_.empty();
  state.scenes = status.names;
  const auto shown = std::find(status.names.begin(), status.names.end(), run_.name);
  if (shown == status.names.end()) return;
  state.scene = static_cast<std::uint16_t>(shown - status.names.begin());
}

}  // namespace irdm
