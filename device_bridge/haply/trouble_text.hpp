#pragma once

#include <mutex>
#include <string>
#include <utility>

namespace irdm::haply {

/// What is wrong with a device and what to do, for a person. Any thread.
class TroubleText {
 public:
  explicit TroubleText(std::string label) : label_(std::move(label)) {}

  /// What the device is called from now on.
  void rename(std::string label) {
    const std::lock_guard<std::mutex> lock(mutex_);
    label_ = std::move(label);
  }
  /// @param what empty: nothing is wrong
  void tell(const std::string& what) {
    const std::lock_guard<std::mutex> lock(mutex_);
    text_ = what.empty() ? "" : label_ + ": " + what;
  }
  std::string label() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return label_;
  }
  std::string text() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return text_;
  }

 private:
  mutable std::mutex mutex_;
  std::string label_;
  std::string text_;
};

}  // namespace irdm::haply
