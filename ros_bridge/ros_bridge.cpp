#include "ros_bridge/ros_bridge.hpp"

#include <spdlog/spdlog.h>
#include <CLI/CLI.hpp>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/toml_reader.hpp"
#include "common/error.hpp"
#include "common/program/stop_signal.hpp"
#include "common/secret/secret_file.hpp"
#include "ros_bridge/surface_topics.hpp"

namespace irdm::ros {
namespace {

struct Options {
  std::string server;
  std::string viewer;
  std::string token_file;
  std::string config;
  bool network = false;
  std::vector<int> styluses;
  std::vector<double> tip{0.0, 0.0, 1.0};
  double stale_after = StylusSettings{}.stale_after;
  std::uint32_t domain = 0;
  std::string name_space = "irdm";
  std::string frame = "irdm";
};

struct Interrupted {};

StylusSettings stylus_settings(const Options& options) {
  StylusSettings settings;
  if (!options.config.empty()) {
    TomlTable root = TomlTable::parse_file(options.config);
    TomlTable table = root.table("bridge");
    read_servo_keys(table, settings.bridge);
    table.finish();
    root.finish();
  }
  settings.bridge.server = parse_server_address(options.server, "--server");
  settings.workspace.rotation = ros_to_world();
  settings.start.tip = Vector3(options.tip.data());
  settings.stale_after = options.stale_after;
  return settings;
}

SurfaceTopics::Styluses connect(const Options& options, const Participant& participant,
                                StopSignal& stop) {
  SurfaceTopics::Styluses styluses;
  if (options.server.empty()) return styluses;
  StylusSettings settings = stylus_settings(options);
  const auto meanwhile = [&stop] {
    if (stop.wait_for(0)) throw Interrupted();
  };
  const auto add = [&] {
    styluses.push_back(
        std::make_unique<StylusTopics>(participant, options.frame, settings, meanwhile));
  };
  if (options.styluses.empty()) add();
  for (const int number : options.styluses) {
    settings.number = number;
    add();
  }
  return styluses;
}

// A command line is seen in the list of processes, so that a token does not stand there.
std::string token_of(const Options& options) {
  if (!options.token_file.empty()) return read_token_file(options.token_file);
  const char* token = std::getenv("IRDM_TOKEN");
  return token == nullptr ? "" : token;
}

bool is_set(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr && *value != '\0';
}

Reach reach(const Options& options) {
  const char* localhost_only = std::getenv("ROS_LOCALHOST_ONLY");
  if (options.network && localhost_only != nullptr && std::string_view(localhost_only) == "1") {
    throw Error("--network", "contradicts ROS_LOCALHOST_ONLY=1", "leave one of them out");
  }
  if (options.network) return Reach::kNetwork;
  if (is_set("CYCLONEDDS_URI")) spdlog::warn("CYCLONEDDS_URI is read with --network only");
  return Reach::kThisMachine;
}

int run(const Options& options) {
  StopSignal stop;
  const std::string token = token_of(options);
  const Participant participant(options.domain, options.name_space, reach(options));
  try {
    const SurfaceTopics::Styluses styluses = connect(options, participant, stop);
    std::optional<SurfaceTopics> surfaces;
    if (!options.viewer.empty()) {
      surfaces.emplace(participant, options.frame, parse_server_address(options.viewer, "--viewer"),
                       token, styluses);
    }
    const int period_ms = styluses.empty() ? -1 : 1;
    while (!stop.wait_for(period_ms)) {
      for (const auto& stylus : styluses) stylus->relay();
    }
  } catch (const Interrupted&) {
  }
  return 0;
}

// CLI11's own check lets "nan" through.
CLI::Validator within(double lowest, double highest) {
  const auto fault = [=](const std::string& text) {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= lowest && value <= highest;
    return good ? std::string() : in_quotes(text) + " is not in the range";
  };
  return {fault, ""};
}

// Words between single slashes, none of which begins with a digit.
std::string fault_of_name(const std::string& text) {
  char before = '/';
  bool good = true;
  for (const char letter : text + '/') {
    const bool digit = letter >= '0' && letter <= '9';
    const bool other = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                       letter == '_' || letter == '/';
    good = good && (digit || other) && !(before == '/' && (digit || letter == '/'));
    before = letter;
  }
  return good ? "" : in_quotes(text) + " is no ROS name";
}

}  // namespace

Command add_options(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::Option* server =
      app.add_option("--server", options->server, "HOST:PORT of irdm-server: styluses");
  app.add_option("--viewer", options->viewer, "HOST:PORT of its viewers: surfaces, poses");
  app.add_option("--token-file", options->token_file,
                 "File of the viewers' token (of viewer.onlooker_token), else IRDM_TOKEN is read");
  app.add_option_function<std::string>(
         "--token",
         [](const std::string&) {
           throw CLI::ValidationError(
               "--token",
               "is no option any more, as the list of processes shows it; give "
               "--token-file FILE or set IRDM_TOKEN");
         })
      ->group("");
  app.add_flag("--network", options->network,
               "Take part in the network's DDS domain, where anyone may command the styluses "
               "(default: this machine only)");
  app.add_option("--stylus", options->styluses,
                 "Numbers of the styluses to lead (default: the first free one)")
      ->check(CLI::Range(0, 15))
      ->needs(server);
  app.add_option("--config", options->config,
                 "TOML file: servo keys of [bridge], as in irdm-bridge's configuration")
      ->needs(server);
  app.add_option("--tip", options->tip,
                 "Where a stylus waits for its first pose, m, each within 2 (default: 0 0 1)")
      ->expected(3)
      ->check(within(-2.0, 2.0));
  app.add_option("--stale-after", options->stale_after,
                 "Seconds for which a pose counts, 0.01 to 10 (default: 0.05)")
      ->check(within(0.01, 10.0));
  app.add_option("--domain", options->domain, "DDS domain (default: 0)")
      ->envname("ROS_DOMAIN_ID")
      ->check(CLI::Range(0, 232));
  app.add_option("--namespace", options->name_space, "Of the topics (default: irdm)")
      ->check(CLI::Validator(fault_of_name, "NAME"));
  app.add_option("--frame", options->frame, "frame_id of the messages (default: irdm)");
  // Required here: one of them is enough.
  app.parse_complete_callback([options] {
    if (options->server.empty() && options->viewer.empty()) {
      throw CLI::RequiredError("--server or --viewer");
    }
  });
  return [options] { return run(*options); };
}

}  // namespace irdm::ros
