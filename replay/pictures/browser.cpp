#include "replay/pictures/browser.hpp"

#include <fcntl.h>
#include <openssl/evp.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/error.hpp"

namespace irdm::replay {
namespace {

void close_end(int& descriptor) noexcept {
  if (descriptor >= 0) ::close(descriptor);
  descriptor = -1;
}

bool wait_for(int descriptor, short event, int patience_ms) {
  pollfd one{descriptor, event, 0};
  int ready = -1;
  do {
    ready = ::poll(&one, 1, patience_ms);
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

}  // namespace

NulDelimitedPipe::NulDelimitedPipe() {
  ::signal(SIGPIPE, SIG_IGN);
  if (::pipe2(in_, O_CLOEXEC) == 0 && ::pipe2(out_, O_CLOEXEC) == 0) {
    ::fcntl(in_[1], F_SETFL, O_NONBLOCK);
    return;
  }
  close();
  close_its_ends();
  throw Error("pipe", "the system has no descriptor left", "raise the limit (ulimit -n)");
}

NulDelimitedPipe::~NulDelimitedPipe() {
  close();
  close_its_ends();
}

void NulDelimitedPipe::close_its_ends() noexcept {
  close_end(in_[0]);
  close_end(out_[1]);
}

void NulDelimitedPipe::close() noexcept {
  close_end(in_[1]);
  close_end(out_[0]);
}

bool NulDelimitedPipe::write(const std::string& text, int patience_ms) {
  // With the zero that a string ends with.
  for (std::size_t done = 0; done <= text.size();) {
    const ssize_t count = ::write(in_[1], text.c_str() + done, text.size() + 1 - done);
    if (count > 0) {
      done += static_cast<std::size_t>(count);
    } else if (errno != EAGAIN && errno != EINTR) {
      return false;
    } else if (!wait_for(in_[1], POLLOUT, patience_ms)) {
      return false;
    }
  }
  return true;
}

bool NulDelimitedPipe::read(std::string& text, int patience_ms) {
  std::array<char, 65536> block;
  std::size_t end = waiting_.find('\0');
  while (end == std::string::npos) {
    if (!wait_for(out_[0], POLLIN, patience_ms)) return false;
    const ssize_t count = ::read(out_[0], block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    const std::size_t before = waiting_.size();
    waiting_.append(block.data(), static_cast<std::size_t>(count));
    end = waiting_.find('\0', before);
  }
  text = waiting_.substr(0, end);
  waiting_.erase(0, end + 1);
  return true;
}

namespace {

using Json = nlohmann::ordered_json;

constexpr int kPatienceMs = 60'000;  // without a GPU a large picture takes seconds

[[noreturn]] void fail(const std::string& problem) {
  throw Error("chromium", problem, "see whether `chromium --headless --screenshot` works");
}

std::vector<std::string> command(const std::filesystem::path& profile) {
  std::vector<std::string> words{"chromium",
                                 "--headless",
                                 "--remote-debugging-pipe",
                                 "--user-data-dir=" + profile.string(),
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--use-angle=swiftshader",
                                 "--enable-unsafe-swiftshader",
                                 "--hide-scrollbars",
                                 "about:blank"};
  if (::geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");  // root has no other way
  return words;
}

std::string from_base64(const std::string& text) {
  std::string bytes(text.size() / 4 * 3, '\0');
  const int length = EVP_DecodeBlock(reinterpret_cast<unsigned char*>(bytes.data()),
                                     reinterpret_cast<const unsigned char*>(text.data()),
                                     static_cast<int>(text.size()));
  if (length < 0) fail("sent a picture that is none");
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  bytes.resize(static_cast<std::size_t>(length) - padding);
  return bytes;
}

// The descriptors of --remote-debugging-pipe.
std::map<int, int> its_descriptors(const NulDelimitedPipe& pipe) {
  return {{3, pipe.its_input()}, {4, pipe.its_output()}};
}

}  // namespace

Browser::Browser(const BrowserWindow& window) {
  chromium_.emplace(command(profile_.path()),
                    ChildSettings{.own_group = true, .descriptors = its_descriptors(pipe_)});
  pipe_.close_its_ends();
  const Json targets = call("Target.getTargets", Json::object());
  std::string page;
  for (const Json& target : targets.at("targetInfos")) {
    if (target.at("type") == "page") page = target.at("targetId").get<std::string>();
  }
  if (page.empty()) fail("has opened no page");
  const Json attached = call("Target.attachToTarget", {{"targetId", page}, {"flatten", true}});
  session_ = attached.at("sessionId").get<std::string>();
  call("Emulation.setDeviceMetricsOverride", {{"width", window.width},
                                              {"height", window.height},
                                              {"deviceScaleFactor", 1},
                                              {"mobile", false}});
  const Json colours{{"name", "prefers-color-scheme"}, {"value", window.dark ? "dark" : "light"}};
  call("Emulation.setEmulatedMedia", {{"features", Json::array({colours})}});
}

void Browser::open(const std::string& url) {
  call("Page.navigate", {{"url", url}});
}

std::string Browser::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate",
           {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (const auto found = answer.find("exceptionDetails"); found != answer.end()) {
    const Json& thrown = found->contains("exception") ? found->at("exception") : Json::object();
    fail("the page says: " + thrown.value("description", found->value("text", "")));
  }
  const Json& result = answer.at("result");
  const auto value = result.find("value");
  if (value == result.end()) return "";
  return value->is_string() ? value->get<std::string>() : value->dump();
}

std::string Browser::picture() {
  const Json answer = call("Page.captureScreenshot", {{"format", "png"}});
  return from_base64(answer.at("data").get<std::string>());
}

// Between a call and its answer there may be events, which have no number.
Json Browser::call(const std::string& method, const Json& parameters) {
  Json request{{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) request["sessionId"] = session_;
  if (!pipe_.write(request.dump(), kPatienceMs)) fail("takes no commands");
  for (;;) {
    std::string text;
    if (!pipe_.read(text, kPatienceMs)) fail("does not answer " + method);
    Json message = Json::parse(text);
    if (message.value("id", 0) != calls_) continue;
    if (const auto error = message.find("error"); error != message.end()) {
      fail("refuses " + method + ": " + error->value("message", ""));
    }
    return std::move(message.at("result"));
  }
}

}  // namespace irdm::replay
