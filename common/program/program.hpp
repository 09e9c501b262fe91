#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

// Declared here so that only sources which define options read CLI11's large header.
namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace irdm {

/// Threads of OpenMP that have nothing to do are to sleep: by default they turn round and round for
/// about a millisecond after each loop, beside the real-time threads. The runtime reads how it is
/// to wait when the program is loaded, so this starts the program again (same process, same
/// arguments) with OMP_WAIT_POLICY=passive. Returns at once when the environment says how to wait.
/// First thing in main().
void wait_passively_in_openmp(char** argv);

// The frame that the mains share: exit 0 on success, 1 on a failure said in one line on stderr,
// 2 on wrong usage.

/// A failure with an exit status of its own; its text is one line, as Error's is.
class StatusError : public std::runtime_error {
 public:
  StatusError(int status, const std::string& what) : std::runtime_error(what), status_(status) {}
  int status() const noexcept { return status_; }

 private:
  int status_;
};

/// Of an option: a finite number above zero. (CLI11's own check lets "nan" through.)
CLI::Validator positive_number();

/// Adds --version, parses the command line and runs `body`; returns the exit status. An exception
/// out of `body` becomes one line on stderr, `NAME: error: WHAT`, and status 1, or that of a
/// StatusError. Beside wrong usage
/// it names the option or command that was probably meant.
int run_program(CLI::App& app, int argc, char** argv, const std::function<int()>& body);

/// Runs a parsed command and returns the exit status; errors are thrown.
using Command = std::function<int()>;

/// Adds a command's options to the command line and returns the command.
using AddCommand = Command (*)(CLI::App& app);

/// Name of a subcommand and the function that adds it.
struct Subcommand {
  std::string name;
  AddCommand add;
};

/// Parses the command line of a program with subcommands and runs the one that was given, or
/// `main_command` when none was. Returns the exit status as run_program() does.
int run_commands(const std::string& name, const std::string& description, int argc, char** argv,
                 AddCommand main_command, const std::vector<Subcommand>& subcommands);

}  // namespace irdm
