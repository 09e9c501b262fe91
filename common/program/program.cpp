#include "common/program/program.hpp"

#include <unistd.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <new>
#include <optional>
#include <system_error>
#include <vector>

#include "common/config/near_word.hpp"
#include "common/error.hpp"

namespace irdm {

void wait_passively_in_openmp(char** argv) {
  for (const char* name : {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT", "KMP_BLOCKTIME"}) {
    if (std::getenv(name) != nullptr) return;
  }
  if (::setenv("OMP_WAIT_POLICY", "passive", 1) != 0) return;
  // By its own name, which lists of processes show.
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (!error) ::execv(self.c_str(), argv);  // returns only on failure: go on as it is
}

namespace {

constexpr int kFailure = 1;
constexpr int kWrongUsage = 2;

int complain(const std::string& program, std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::cerr << program << ": error: " << text << std::endl;
  return kFailure;
}

// Of the program and of the command that was given.
std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // hidden
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const CLI::App* command : app.get_subcommands()) {
    const std::vector<std::string> more = option_names(*command);
    names.insert(names.end(), more.begin(), more.end());
  }
  return names;
}

// Empty where nothing is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& words) {
  const std::optional<std::string> near = nearest_word(word, words);
  return near ? "did you mean " + *near + " in place of " + shortened(word) + "?\n" : "";
}

// Of a first word that neither is a command nor names a file.
std::string meant_command(const CLI::App& app, int argc, char** argv) {
  std::error_code ignored;
  if (argc < 2 || !app.get_subcommands().empty() || std::filesystem::exists(argv[1], ignored)) {
    return "";
  }
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    commands.push_back(command->get_name());
  }
  return suggestion(argv[1], commands);
}

std::string meant_options(const CLI::App& app) {
  std::string text;
  for (const std::string& word : app.remaining(true)) {
    if (word.starts_with('-'))
      text += suggestion(word.substr(0, word.find('=')), option_names(app));
  }
  return text;
}

int say_wrong_usage(const CLI::App& app, const CLI::ParseError& error, const std::string& command) {
  if (error.get_exit_code() != 0) std::cerr << command << meant_options(app);
  return app.exit(error) == 0 ? 0 : kWrongUsage;
}

}  // namespace

CLI::Validator positive_number() {
  const auto check = [](const std::string& text) {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
    return good ? std::string() : in_quotes(text) + " is not a finite number above 0";
  };
  return {check, "POSITIVE", "positive_number"};
}

int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body) {
  app.set_version_flag("--version", app.get_name() + " " + IRDM_VERSION);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return say_wrong_usage(app, error, meant_command(app, argc, argv));
  }
  const std::string command = meant_command(app, argc, argv);
  if (!command.empty()) {
    std::cerr << argv[1] << ": no such file\n" << command;
    return kWrongUsage;
  }
  try {
    return body();
  } catch (const StatusError& error) {
    complain(app.get_name(), error.what());
    return error.status();
  } catch (const std::bad_alloc&) {
    return complain(app.get_name(), "not enough memory; use a smaller model or free memory");
  } catch (const std::system_error& error) {
    if (error.code() != std::errc::resource_unavailable_try_again) {
      return complain(app.get_name(), error.what());
    }
    return complain(app.get_name(),
                    "no thread can be started: too little memory or too many processes; raise the "
                    "limits (ulimit -v, ulimit -u)");
  } catch (const std::exception& error) {
    return complain(app.get_name(), error.what());
  }
}

int run_commands(const std::string& name, const std::string& description, int argc, char** argv,
                 AddCommand main_command, const std::vector<Subcommand>& subcommands) {
  CLI::App app(description, name);
  app.require_subcommand(0, 1);
  const Command run = main_command(app);
  std::map<std::string, Command> commands;
  for (const Subcommand& each : subcommands) commands.emplace(each.name, each.add(app));
  return run_program(app, argc, argv, [&] {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? run() : commands.at(chosen.front()->get_name())();
  });
}

}  // namespace irdm
