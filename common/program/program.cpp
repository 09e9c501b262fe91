#include "common/program/program.hpp"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>

#include "common/error.hpp"

namespace irdm {

StopSignal::StopSignal() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // what does not fit is an error of the write
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  // A terminal that closes; nohup's children ignore it.
  struct sigaction hangup {};
  const bool ignored = sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_IGN;
  if (!ignored) sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  descriptor_ = signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  if (descriptor_ < 0) {
    throw Error("system", "no file descriptor for signals is left", "raise the limit (ulimit -n)");
  }
}

StopSignal::~StopSignal() {
  ::close(descriptor_);
}

bool StopSignal::wait(int other_descriptor, int third_descriptor) {
  pollfd entries[3] = {
      {descriptor_, POLLIN, 0}, {other_descriptor, POLLIN, 0}, {third_descriptor, POLLIN, 0}};
  while (::poll(entries, 3, -1) < 0 && errno == EINTR) {
  }
  return entries[0].revents != 0;
}

bool StopSignal::wait_for(int timeout_ms, int other_descriptor) {
  pollfd entries[2] = {{descriptor_, POLLIN, 0}, {other_descriptor, POLLIN, 0}};
  return ::poll(entries, 2, timeout_ms) > 0 && entries[0].revents != 0;
}

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
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  try {
    return body();
  } catch (const std::bad_alloc&) {
    return complain(app.get_name(), "not enough memory; use a smaller model or free memory");
  } catch (const std::exception& error) {
    return complain(app.get_name(), error.what());
  }
}

}  // namespace irdm
