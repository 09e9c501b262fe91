#pragma once

#include <string>

#include "device_bridge/commission/step.hpp"

namespace irdm::commission {

/// Who commissions a device. Main thread.
class Person {
 public:
  Person() = default;
  Person(const Person&) = delete;
  Person& operator=(const Person&) = delete;
  virtual ~Person() = default;

  virtual void tell(const std::string& line) = 0;
  /// Is told what a step asks for; true once ready, false: to end here.
  virtual bool begins(const Step& step) = 0;
  virtual bool confirms(const std::string& question) = 0;
  /// Whether the person wants the step that runs to stop, after at most `timeout_ms`.
  virtual bool stops(int timeout_ms) = 0;
};

}  // namespace irdm::commission
