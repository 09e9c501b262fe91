#include "server/scene_loader.hpp"

#include <exception>

#include "common/realtime/scheduling.hpp"
#include "scene/saved_scene.hpp"
#include "scene/scene_folder.hpp"

namespace irdm {
namespace {
constexpr int kListPeriodMs = 2000;
}  // namespace

SceneLoader::SceneLoader(std::optional<std::filesystem::path> folder, Prepare prepare)
    : folder_(std::move(folder)), prepare_(std::move(prepare)) {
  if (folder_) now_.names = scenes_in(*folder_);
  status_.put(now_);
}

SceneLoader::~SceneLoader() {
  finish();
}

std::string SceneLoader::name_of(const SceneSource& source) const {
  std::error_code failure;
  const bool inside = folder_ && std::filesystem::equivalent(source.folder, *folder_, failure);
  return inside ? std::filesystem::path(source.name).filename().string() : "";
}

void SceneLoader::start() {
  if (!folder_ || thread_.joinable()) return;
  thread_ = std::thread([this] { run(); });
}

void SceneLoader::finish() {
  if (!thread_.joinable()) return;
  stopping_.store(true);
  asked_.signal();
  thread_.join();
}

const SceneLoaderStatus& SceneLoader::status() {
  status_.receive();
  return status_.front();
}

bool SceneLoader::busy() {
  return waiting_.load() || status().done != asked_count_;
}

void SceneLoader::load(const std::string& name) {
  ask({name});
}

void SceneLoader::save(const SceneSource& source, const Settings& initial,
                       const Settings& settings) {
  if (ask({"", source, initial, settings})) ++saves_;
}

bool SceneLoader::ask(const Request& request) {
  if (!possible() || busy() || !requests_.push(request)) return false;
  ++asked_count_;
  asked_.signal();
  return true;
}

void SceneLoader::run() {
  spare_last_cpu();
  while (!stopping_.load()) {
    const bool asked = asked_.wait(kListPeriodMs);
    Request request;
    while (!stopping_.load() && requests_.pop(request)) handle(request);
    std::vector<std::string> names = scenes_in(*folder_);
    if (!asked && names == now_.names) continue;
    now_.names = std::move(names);
    status_.put(now_);
  }
}

void SceneLoader::handle(const Request& request) {
  loading_.store(!request.name.empty());
  try {
    now_.notice = request.name.empty() ? save_now(request) : load_now(request.name);
  } catch (const std::bad_alloc&) {
    now_.notice = request.name + ": takes more memory than there is; choose a smaller one";
  } catch (const std::exception& error) {
    now_.notice = error.what();
  }
  loading_.store(false);
  ++now_.done;
}

std::string SceneLoader::load_now(const std::string& name) {
  std::unique_ptr<PreparedRun> prepared = prepare_(scene_in(*folder_, name));
  prepared->name = name;
  prepared->greeting = "loaded: " + name;
  {
    const std::lock_guard lock(prepared_mutex_);
    prepared_ = std::move(prepared);
  }
  waiting_.store(true);
  ready_.signal();
  return "";
}

std::string SceneLoader::save_now(const Request& request) {
  return "saved: " + save_scene(request.source, request.initial, request.settings, *folder_);
}

std::unique_ptr<PreparedRun> SceneLoader::take() {
  const std::lock_guard lock(prepared_mutex_);
  ready_.consume();
  waiting_.store(false);
  return std::move(prepared_);
}

}  // namespace irdm
