#include "bench/echo.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "bench/statistics.hpp"
#include "tests/support/loopback.hpp"

namespace irdm::bench {
namespace {

using test::loopback;

void require(bool holds, const char* what) {
  if (!holds) throw std::runtime_error(what);
}

int listen_on_free_port(std::uint16_t& port) {
  const int listener = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = loopback(0);
  auto* plain = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof address;
  require(::bind(listener, plain, size) == 0 && ::listen(listener, 1) == 0 &&
              ::getsockname(listener, plain, &size) == 0,
          "cannot listen");
  port = ntohs(address.sin_port);
  return listener;
}

int connect_to(std::uint16_t port) {
  const int descriptor = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  require(::connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0,
          "cannot connect");
  return descriptor;
}

}  // namespace

Wire::Wire(std::uint16_t port) : Wire(connect_to(port)) {}

Wire::Wire(int descriptor) : descriptor_(descriptor) {
  const int on = 1;
  ::setsockopt(descriptor_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

Wire::~Wire() {
  ::close(descriptor_);
}

void Wire::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    require(sent > 0, "the other side has hung up");
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
}

std::size_t Wire::receive_some(std::span<std::uint8_t> bytes) {
  const ssize_t got = ::recv(descriptor_, bytes.data(), bytes.size(), 0);
  return got > 0 ? static_cast<std::size_t>(got) : 0;
}

bool Wire::receive(std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const std::size_t got = receive_some(bytes);
    if (got == 0) return false;
    bytes = bytes.subspan(got);
  }
  return true;
}

Echo::Echo(std::size_t asked, std::size_t answered) : question_(asked, 1), answer_(answered, 2) {
  std::uint16_t port = 0;
  const int listener = listen_on_free_port(port);
  child_ = ::fork();
  if (child_ == 0) {
    Wire wire(::accept(listener, nullptr, nullptr));
    while (wire.receive(question_)) wire.send(answer_);
    ::_exit(0);
  }
  ::close(listener);
  wire_ = std::make_unique<Wire>(port);
}

Echo::~Echo() {
  wire_.reset();
  ::waitpid(child_, nullptr, 0);
}

double Echo::round_trip() {
  return seconds([&] {
    wire_->send(question_);
    require(wire_->receive(answer_), "the echo is gone");
  });
}

}  // namespace irdm::bench
