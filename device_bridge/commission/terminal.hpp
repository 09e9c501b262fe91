#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "common/program/stop_signal.hpp"
#include "device_bridge/commission/guided_stylus.hpp"
#include "device_bridge/commission/person.hpp"

namespace irdm::commission {

/// A person at a terminal, or lines that come through a pipe. A line begins a step; while one runs,
/// any key stops it, and so do SIGINT and SIGTERM. Where nothing can be read any more, no step
/// begins.
class Terminal final : public Person {
 public:
  /// @param input descriptor to read from
  Terminal(StopSignal& signal, int input, std::ostream& output)
      : signal_(signal), input_(input), output_(output) {}

  void tell(const std::string& line) override;
  bool begins(const Step& step) override;
  bool confirms(const std::string& question) override;
  bool stops(int timeout_ms) override;

 private:
  std::optional<char> next_letter();
  std::optional<std::string> next_line();

  StopSignal& signal_;
  int input_;
  std::ostream& output_;
  bool ended_ = false;  ///< there is nothing to read any more
};

/// The person who holds a virtual device does what is asked; who watches may stop it.
class SimulatedPerson final : public Person {
 public:
  SimulatedPerson(Terminal& watcher, GuidedStylus& stylus) : watcher_(watcher), stylus_(stylus) {}

  void tell(const std::string& line) override { watcher_.tell(line); }
  bool begins(const Step& step) override;
  bool confirms(const std::string&) override { return true; }
  bool stops(int timeout_ms) override { return watcher_.stops(timeout_ms); }

 private:
  Terminal& watcher_;
  GuidedStylus& stylus_;
};

}  // namespace irdm::commission
