#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/process/child_program.hpp"
#include "common/process/temporary_files.hpp"

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

/// A window without a screen.
struct BrowserWindow {
  int width = 1280;  ///< [px]
  int height = 720;
  bool dark = false;  ///< its pages are asked for their dark colours
};

/// Debian's Chromium without a screen, which draws without a GPU too, led through its DevTools
/// protocol over a pipe. One thread. What goes wrong is thrown as an Error.
class Browser {
 public:
  explicit Browser(const BrowserWindow& window);
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Begins to load a page.
  void open(const std::string& url);
  /// The value of an expression in JavaScript, as text; of a promise once it is kept.
  std::string evaluate(const std::string& expression);
  /// The window as it is: a PNG file's bytes.
  std::string picture();

 private:
  nlohmann::ordered_json call(const std::string& method, const nlohmann::ordered_json& parameters);

  // In this order: Chromium ends when its pipe does.
  TemporaryFolder profile_{"irdm-pictures"};
  std::optional<ChildProgram> chromium_;
  NulDelimitedPipe pipe_;
  std::string session_;
  int calls_ = 0;
};

}  // namespace irdm::replay
