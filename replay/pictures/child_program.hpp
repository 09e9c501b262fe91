#pragma once

#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace irdm::replay {

/// A program that another one starts, without its terminal and deaf to the terminal's Ctrl-C. Ends
/// with this object.
class ChildProgram {
 public:
  /// @param command first the program, as it is found by PATH
  /// @param descriptors of this process, by the number that the program shall have them under
  /// @param quiet whether what it says on stderr is lost
  /// Throws Error when it cannot be started.
  ChildProgram(std::vector<std::string> command, const std::map<int, int>& descriptors, bool quiet);
  ChildProgram(const ChildProgram&) = delete;
  ChildProgram& operator=(const ChildProgram&) = delete;
  ~ChildProgram();  ///< gives it some seconds to end by itself

  /// Its exit status once it has ended; -1: a signal has ended it.
  int wait() noexcept;

 private:
  bool ended(int options) noexcept;

  pid_t pid_ = 0;
  int status_ = -1;
};

/// Whether PATH has a program of that name.
bool program_exists(const std::string& name);

}  // namespace irdm::replay
