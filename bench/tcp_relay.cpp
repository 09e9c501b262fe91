#include "bench/tcp_relay.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <list>
#include <stdexcept>
#include <vector>

namespace irdm {
namespace {

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// Two sockets, and the bytes from each to the other.
struct Pair {
  std::array<int, 2> sockets;
  bool open = true;

  /// Hands on what has come in at one end.
  void forward(std::size_t from) {
    std::array<char, 65536> bytes;
    const ssize_t size = ::recv(sockets[from], bytes.data(), bytes.size(), 0);
    open = size > 0 && ::send(sockets[1 - from], bytes.data(), static_cast<std::size_t>(size),
                              MSG_NOSIGNAL) == size;
  }
  void close() {
    for (const int socket : sockets) ::close(socket);
  }
};

int connect_to(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  const sockaddr_in address = loopback(port);
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
    return socket;
  }
  ::close(socket);
  return -1;
}

void no_delay(int socket) {
  const int on = 1;
  ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
}

}  // namespace

TcpRelay::TcpRelay(std::uint16_t target)
    : target_(target), listener_(::socket(AF_INET, SOCK_STREAM, 0)) {
  constexpr int kWaiting = 0;
  sockaddr_in address = loopback(0);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  if (::bind(listener_, generic, size) != 0 || ::listen(listener_, kWaiting) != 0 ||
      ::getsockname(listener_, generic, &size) != 0) {
    throw std::runtime_error("cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { run(); });
}

TcpRelay::~TcpRelay() {
  stop_ = true;
  change_.signal();
  thread_.join();
  ::close(listener_);
}

void TcpRelay::cut() noexcept {
  cut_ = true;
  change_.signal();
}

void TcpRelay::mend() noexcept {
  cut_ = false;
  change_.signal();
}

void TcpRelay::run() {
  std::list<Pair> pairs;
  while (!stop_) {
    std::vector<pollfd> entries{{change_.descriptor(), POLLIN, 0}};
    std::vector<Pair*> owners;
    if (!cut_) {
      entries.push_back({listener_, POLLIN, 0});
      for (Pair& pair : pairs) {
        for (const int socket : pair.sockets) entries.push_back({socket, POLLIN, 0});
        owners.push_back(&pair);
      }
    }
    if (::poll(entries.data(), entries.size(), -1) < 0) continue;
    if (change_.consume()) continue;
    for (std::size_t i = 2; i < entries.size(); ++i) {
      Pair& pair = *owners[(i - 2) / 2];
      if (entries[i].revents != 0 && pair.open) pair.forward(i % 2);
    }
    if (entries[1].revents != 0) {
      const int guest = ::accept(listener_, nullptr, nullptr);
      const int host = connect_to(target_);
      Pair pair{{guest, host}, guest >= 0 && host >= 0};
      for (const int socket : pair.sockets) no_delay(socket);
      pairs.push_back(pair);
    }
    pairs.remove_if([](Pair& pair) {
      if (!pair.open) pair.close();
      return !pair.open;
    });
  }
  for (Pair& pair : pairs) pair.close();
}

}  // namespace irdm
