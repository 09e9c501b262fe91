#pragma once

#include <string>

namespace irdm::replay {

/// Texts with a zero byte at their end, to another process and back, over a pipe each way.
class NulDelimitedPipe {
 public:
  /// Throws Error when the system has no descriptors left.
  NulDelimitedPipe();
  NulDelimitedPipe(const NulDelimitedPipe&) = delete;
  NulDelimitedPipe& operator=(const NulDelimitedPipe&) = delete;
  ~NulDelimitedPipe();

  /// For the other process: where it reads and writes.
  int its_input() const noexcept { return in_[0]; }
  int its_output() const noexcept { return out_[1]; }
  /// When the other process has them.
  void close_its_ends() noexcept;
  /// After which it reads no more.
  void close() noexcept;

  /// Both wait; false: the other process is gone, or takes or gives nothing for `patience_ms`.
  bool write(const std::string& text, int patience_ms);
  bool read(std::string& text, int patience_ms);

 private:
  int in_[2] = {-1, -1};   // to the other process
  int out_[2] = {-1, -1};  // from it
  std::string waiting_;    // read, and not taken yet
};

}  // namespace irdm::replay
