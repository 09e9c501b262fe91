#include "tests/network_namespace/two_namespaces.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>
#include <thread>

#include "common/error.hpp"

namespace irdm::test {
namespace {

constexpr const char* kDevice = "irdm-path";

[[noreturn]] void fail(const char* what) {
  throw Error("network namespaces", std::string(what) + ": " + std::strerror(errno),
              "needs root and a kernel that allows them");
}

ifreq request() {
  ifreq request{};
  std::strncpy(request.ifr_name, kDevice, IFNAMSIZ - 1);
  return request;
}

ifreq request(const std::string& address) {
  ifreq made = request();
  auto* to = reinterpret_cast<sockaddr_in*>(&made.ifr_addr);
  to->sin_family = AF_INET;
  ::inet_pton(AF_INET, address.c_str(), &to->sin_addr);
  return made;
}

/// In the calling thread's namespace, between these addresses.
void raise_device(const std::string& own, const std::string& other) {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ifreq address = request(own);
  ifreq peer = request(other);
  ifreq flags = request();
  flags.ifr_flags = IFF_UP | IFF_RUNNING | IFF_POINTOPOINT;
  const bool done = socket >= 0 && ::ioctl(socket, SIOCSIFADDR, &address) == 0 &&
                    ::ioctl(socket, SIOCSIFDSTADDR, &peer) == 0 &&
                    ::ioctl(socket, SIOCSIFFLAGS, &flags) == 0;
  const int error = errno;
  ::close(socket);
  errno = error;
  if (!done) fail("cannot raise a TUN device");
}

int open_device() {
  const int device = ::open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device < 0) fail("cannot open /dev/net/tun");
  ifreq kind = request();
  kind.ifr_flags = IFF_TUN | IFF_NO_PI;
  if (::ioctl(device, TUNSETIFF, &kind) == 0) return device;
  const int error = errno;
  ::close(device);
  errno = error;
  fail("cannot make a TUN device");
}

}  // namespace

std::string TwoNamespaces::address(std::size_t which) {
  return "10.83.0." + std::to_string(which + 1);
}

// On a thread of their own: a thread that has left its namespace does not come back to it here.
TwoNamespaces::TwoNamespaces() {
  std::exception_ptr error;
  std::thread([&] {
    try {
      for (const std::size_t which : {0, 1}) make(which);
    } catch (...) {
      error = std::current_exception();
    }
  }).join();
  if (!error) return;
  for (const int each : {namespaces_[0], namespaces_[1], devices_[0], devices_[1]}) ::close(each);
  std::rethrow_exception(error);
}

TwoNamespaces::~TwoNamespaces() {
  for (const int each : {namespaces_[0], namespaces_[1], devices_[0], devices_[1]}) ::close(each);
}

void TwoNamespaces::make(std::size_t which) {
  if (::unshare(CLONE_NEWNET) != 0) fail("cannot make a network namespace");
  namespaces_[which] = ::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC);
  if (namespaces_[which] < 0) fail("cannot open a network namespace");
  devices_[which] = open_device();
  raise_device(address(which), address(1 - which));
}

std::vector<std::string> TwoNamespaces::inside(std::size_t which,
                                               const std::vector<std::string>& command) const {
  std::vector<std::string> words = {
      "/usr/bin/env",
      "setpriv",
      "--pdeathsig",
      "KILL",
      "nsenter",
      "--net=/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(namespaces_[which])};
  words.insert(words.end(), command.begin(), command.end());
  return words;
}

void TwoNamespaces::enter(std::size_t which) const {
  if (::setns(namespaces_[which], CLONE_NEWNET) != 0) fail("cannot enter a network namespace");
}

}  // namespace irdm::test
