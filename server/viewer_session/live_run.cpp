#include "server/viewer_session/live_run.hpp"

#include <utility>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"
#include "server/threads/status_thread.hpp"
#include "viewer/scene_message.hpp"

namespace irdm {
namespace {

using viewer::CommandKind;

viewer::Percentiles percentiles(const Histogram& histogram) {
  if (histogram.count() == 0) return {};
  const auto microseconds = [](std::int64_t ns) { return static_cast<float>(ns) / 1000.0F; };
  return {microseconds(histogram.percentile(0.5)), microseconds(histogram.percentile(0.99)),
          microseconds(histogram.maximum())};
}

}  // namespace

LiveRun::LiveRun(viewer::Scene scene, SimulationConfig config, const Parts& parts,
                 std::string notice)
    : scene_(std::move(scene)),
      config_(std::move(config)),
      parts_(parts),
      playback_(parts.player),
      settings_(initial_settings(config_)),
      notice_(std::move(notice)),
      since_ns_(monotonic_ns()) {}

std::vector<viewer::SurfaceSource> LiveRun::sources() {
  return {{parts_.deformation.surfaces(), parts_.deformation.surface_ready()},
          {parts_.player.surfaces(), parts_.player.surface_ready()}};
}

viewer::Health LiveRun::health() {
  parts_.force.health().receive();
  const ForceHealth& force = parts_.force.health().front();
  const NetworkStats& network = parts_.network.stats();
  viewer::Health health;
  if (force.withheld != std::exchange(withheld_, force.withheld)) {
    notice_ = withheld_line(force.withheld);
  }
  health.steps = force.steps;
  health.step_time = percentiles(force.step_time);
  health.wakeup_delay = percentiles(force.wakeup_delay);
  health.missed = force.missed;
  health.unsolved = force.unsolved;
  health.resets = force.resets;
  health.lost_steps = parts_.deformation.lost_steps();
  health.surface_rate = surface_rate();
  health.sessions = network.accepted;
  health.samples = network.samples;
  health.forces = network.forces;
  health.forces_replaced = network.forces_replaced;
  health.protocol_errors = network.protocol_errors;
  for (int s = 0; s < parts_.network.styluses(); ++s) health.links.push_back(link_health(s));
  return health;
}

viewer::LinkHealth LiveRun::link_health(int stylus) {
  const auto percentiles_of = [](const wire::Quantiles& quantiles) -> viewer::Percentiles {
    return {quantiles.median, quantiles.p99, quantiles.maximum};
  };
  TripleBuffer<LinkReport>& link = parts_.network.port(stylus).link;
  link.receive();
  const LinkReport& report = link.front();
  return {report.reported, percentiles_of(report.report.round_trip),
          percentiles_of(report.report.age)};
}

// Over the last second or so, however often it is asked for.
float LiveRun::surface_rate() {
  constexpr std::int64_t kWindowNs = 1'000'000'000;
  const std::int64_t now_ns = monotonic_ns();
  if (now_ns - since_ns_ < kWindowNs) return rate_;
  const std::uint64_t frames = parts_.deformation.frames();
  rate_ = static_cast<float>(1e9 * static_cast<double>(frames - frames_) /
                             static_cast<double>(now_ns - since_ns_));
  frames_ = frames;
  since_ns_ = now_ns;
  return rate_;
}

viewer::State LiveRun::state() {
  viewer::State state;
  const bool was_on = playback_.on();
  playback_.report(state, notice_);
  if (was_on && !playback_.on()) show_live();
  notice_failed_recordings();
  state.paused = parts_.control.paused();
  state.recording = parts_.recordings.recording();
  state.can_record = parts_.recordings.possible();
  state.settings_changes = settings_changes_;
  parts_.scenes.report(state, notice_);
  for (const std::filesystem::path& path : parts_.recordings.complete()) {
    const auto number = static_cast<std::uint16_t>(state.recordings.size());
    state.recordings.push_back({number, path.filename().string()});
  }
  state.notice = notice_;
  state.settings = settings_;
  state.choices = settings_choices(config_);
  return state;
}

void LiveRun::notice_failed_recordings() {
  if (parts_.run_recorder != nullptr && parts_.run_recorder->failed() && !failure_noticed_) {
    failure_noticed_ = true;
    notice_ = "recording ended early: " + parts_.run_recorder->error();
  }
  if (!parts_.recordings.failed()) return;
  try {
    parts_.recordings.end();
  } catch (const Error& error) {
    notice_ = error.what();
  }
}

void LiveRun::handle(const viewer::Command& command) {
  notice_.clear();
  try {
    if (!playback_.handle(command)) handle_live(command);
  } catch (const Error& error) {
    notice_ = error.what();
  }
}

void LiveRun::handle_live(const viewer::Command& command) {
  RunControl& control = parts_.control;
  switch (command.kind) {
    case CommandKind::kReset:
      return control.request_reset();
    case CommandKind::kPause:
      return control.pause();
    case CommandKind::kResume:
      if (playback_.on()) show_live();
      return control.resume();
    case CommandKind::kStep:
      if (!playback_.on()) control.request_steps(command.number);
      return;
    case CommandKind::kRecord:
      return begin_recording();
    case CommandKind::kEndRecording:
      if (!parts_.recordings.recording()) return;
      parts_.recordings.end();
      notice_ = "recorded: " + parts_.recordings.complete().back().filename().string();
      return;
    case CommandKind::kShowRecording:
      return show_recording(command.number);
    case CommandKind::kShowLive:
      if (playback_.on()) show_live();
      return;
    case CommandKind::kSaveScene:
      return save_scene();
    default:
      return;  // of a recorded run, and none is shown
  }
}

// A scene that is being read has the HDF5 library for itself.
void LiveRun::begin_recording() {
  if (parts_.scenes.preparing()) {
    throw Error("recording", "cannot begin while a scene is loaded", "wait for the scene");
  }
  if (playback_.on()) show_live();
  parts_.recordings.begin();
  parts_.control.request_reset();
}

void LiveRun::save_scene() {
  if (playback_.on()) throw Error("settings", "are of a recorded run", "go back to the live one");
  parts_.scenes.save(settings_);
}

void LiveRun::show_recording(std::size_t number) {
  const auto& complete = parts_.recordings.complete();
  if (number >= complete.size()) throw Error("recording", "is not there", "choose another one");
  if (parts_.recordings.recording()) {
    throw Error("recording", "is being made", "end it before one is shown");
  }
  if (!playback_.on()) paused_before_playback_ = parts_.control.paused();
  parts_.control.pause();
  playback_.show(complete[number], static_cast<std::uint16_t>(number));
}

void LiveRun::show_live() {
  playback_.leave();
  if (!paused_before_playback_) parts_.control.resume();
}

void LiveRun::handle(const viewer::SettingsRequest& request) {
  notice_.clear();
  try {
    check_settings(config_, request.settings);
  } catch (const Error& error) {
    notice_ = error.what();
    return;
  }
  if (request.settings == settings_) return;
  settings_ = request.settings;
  ++settings_changes_;
  parts_.control.set(settings_);
}

void LiveRun::handle(const viewer::SceneRequest& request) {
  notice_.clear();
  try {
    if (parts_.recordings.recording()) {
      throw Error("recording", "is being made", "end it before another scene is loaded");
    }
    parts_.scenes.load(request.name);
  } catch (const Error& error) {
    notice_ = error.what();
  }
}

void LiveRun::handle(const viewer::StylusRequest& request) {
  StylusInput input;
  input.present = request.present && !playback_.on();
  input.sample.sequence = ++stylus_sequence_;
  input.sample.time_ns = monotonic_ns();
  input.sample.buttons = request.buttons & kGrabButton;
  input.sample.tip = request.tip;
  parts_.control.stylus().put(input);
}

}  // namespace irdm
