#pragma once

#include <optional>
#include <string>

#include "common/process/child_program.hpp"
#include "common/process/temporary_folder.hpp"
#include "replay/pictures/nul_delimited_pipe.hpp"

namespace irdm::replay {

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
  struct Answer;

  Answer call(const std::string& method, const std::string& parameters);

  // In this order: Chromium ends when its pipe does.
  TemporaryFolder profile_{"irdm-pictures"};
  std::optional<ChildProgram> chromium_;
  NulDelimitedPipe pipe_;
  std::string session_;
  int calls_ = 0;
};

}  // namespace irdm::replay
