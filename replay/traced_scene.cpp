#include "replay/traced_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/checksum.hpp"
#include "common/error.hpp"
#include "replay/replay.hpp"
#include "scene/scene.hpp"
#include "trace/recording.hpp"
#include "trace/trace_layout.hpp"

namespace irdm {

ResponseKind replay::engine_from_word(const std::string& word) {
  if (word == "dense") return ResponseKind::kDense;
  return word == "compressed" ? ResponseKind::kCompressed : ResponseKind::kModal;
}

namespace replay {
namespace {

const char* word_of(ResponseKind kind) {
  constexpr std::array<const char*, 3> kWords{"modal", "dense", "compressed"};
  return kWords.at(static_cast<std::size_t>(kind));
}

// FILE is for the only object, NAME=FILE for the one of that name.
std::optional<std::filesystem::path> given_model(const std::vector<std::string>& models,
                                                 const std::string& name, bool several) {
  for (const std::string& model : models) {
    if (model.starts_with(name + "=")) return model.substr(name.size() + 1);
    if (!several) return model;
  }
  return std::nullopt;
}

void check_given(const std::vector<std::string>& models, const SceneConfig& scene) {
  if (scene.objects.size() == 1 && models.size() <= 1) return;
  for (const std::string& model : models) {
    if (std::any_of(scene.objects.begin(), scene.objects.end(), [&](const ObjectConfig& object) {
          return model.starts_with(object.name + "=");
        })) {
      continue;
    }
    throw Error(
        "--model " + model,
        "names none of the " + std::to_string(scene.objects.size()) + " objects of the trace",
        "give NAME=FILE, for instance " + scene.objects.front().name + "=" + model);
  }
}

/// Where the model of an object may be, the likeliest first.
std::vector<std::filesystem::path> places(const std::filesystem::path& trace,
                                          const TraceObject& object,
                                          const std::filesystem::path& in_scene) {
  return {std::filesystem::absolute(trace).parent_path() / object.model_file, object.model_file,
          in_scene, std::filesystem::absolute(trace).parent_path() / in_scene};
}

std::filesystem::path find_model(const std::filesystem::path& trace, const TraceObject& object,
                                 const std::filesystem::path& in_scene) {
  std::string other;
  for (const std::filesystem::path& path : places(trace, object, in_scene)) {
    if (!std::filesystem::is_regular_file(path)) continue;
    if (sha256_of_file(path) == object.model_checksum) return path;
    if (other.empty()) other = path.string();
  }
  if (other.empty()) {
    throw Error(trace.string(),
                "was recorded with " + shortened(object.model_file) + ", which is not there",
                "give it with --model");
  }
  throw Error(other, "is not the model that " + trace.string() + " was recorded with",
              "give that one with --model, or this one to see what it would do");
}

/// Of a traced scene while it is read.
struct Reading {
  const std::filesystem::path& trace;
  const std::vector<std::string>& models;
  TracedScene traced;

  void add(const TraceObject& object, ObjectConfig& config, bool several);
};

void Reading::add(const TraceObject& object, ObjectConfig& config, bool several) {
  const auto given = given_model(models, object.name, several);
  config.model = given ? *given : find_model(trace, object, config.model);
  const std::string checksum = given ? sha256_of_file(*given) : object.model_checksum;
  if (checksum != object.model_checksum) {
    traced.warnings.push_back(config.model.string() + " is not the model that " + trace.string() +
                              " was recorded with; its surface nodes are taken to be the same");
  }
  traced.objects.push_back({object.name, config.model, checksum, config.engine});
}

void check_dt(const TracedScene& scene, double dt, const std::string& trace) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const double own = scene.config.objects[i].model->dt;
    if (std::abs(own - dt) <= 1e-12 * dt) continue;
    throw Error(scene.objects[i].model.string(),
                "has steps of " + std::to_string(own) + " s, and " + trace + " of " +
                    std::to_string(dt) + " s",
                "give a model with the trace's dt");
  }
}

}  // namespace

std::vector<std::string> TracedScene::names() const {
  std::vector<std::string> names;
  for (const TracedObject& object : objects) names.push_back(object.name);
  return names;
}

std::string TracedScene::engine_words() const {
  std::string words;
  for (const TracedObject& object : objects) {
    if (!words.empty()) words += ", ";
    words += word_of(object.engine);
  }
  return words;
}

TracedScene read_traced_scene(const std::filesystem::path& trace,
                              const std::vector<std::string>& models,
                              std::optional<ResponseKind> engine) {
  const TraceHeader header = read_trace_header(trace);
  SceneConfig scene = read_scene(TomlTable::parse_text(header.scene, trace.string() + ", scene"));
  check_given(models, scene);
  std::vector<std::string> names;
  for (const ObjectConfig& object : scene.objects) names.push_back(object.name);
  const std::vector<TraceObject> objects = read_trace_objects(trace, names);
  Reading reading{trace, models, {}};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    ObjectConfig& object = scene.objects[i];
    if (engine) object.engine = *engine;
    reading.add(objects[i], object, objects.size() > 1);
  }
  TracedScene traced = std::move(reading.traced);
  traced.config =
      simulation_config(scene, recorded_viewer_stylus(scene, header.stylus_count, trace.string()));
  if (!header.bodies) traced.config.between_objects = traced.config.self_contact = false;
  if (!header.sleep) traced.config.sleep_time = 0.0;
  check_dt(traced, header.dt, trace.string());
  return traced;
}

}  // namespace replay
}  // namespace irdm
