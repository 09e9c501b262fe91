#include "tests/fuzz/line.hpp"

#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <array>
#include <cstdlib>
#include <utility>

#include "tests/fuzz/mended_frames.hpp"

namespace irdm::fuzz {

using boost::asio::ip::tcp;

Line::Line(Kind kind) {
  spdlog::set_level(spdlog::level::off);
  if (kind == Kind::kLoopback) {
    connect(tcp::acceptor(context_, tcp::endpoint(boost::asio::ip::address_v4::loopback(), 0)));
    return;
  }
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) std::abort();
  near_.assign(tcp::v4(), ends[0]);
  far_.assign(tcp::v4(), ends[1]);
}

// Both ends are reset at last: a port is free again at once.
void Line::connect(tcp::acceptor&& acceptor) {
  near_.connect(acceptor.local_endpoint());
  acceptor.accept(far_);
  near_.set_option(tcp::socket::linger(true, 0));
  far_.set_option(tcp::socket::linger(true, 0));
  far_.set_option(tcp::no_delay(true));
}

std::shared_ptr<wire::Connection> Line::connection() {
  return std::make_shared<wire::Connection>(wire::make_plain_stream(std::move(near_)));
}

void Line::say(Input bytes) {
  boost::system::error_code ignored;
  boost::asio::write(far_, boost::asio::buffer(bytes.data(), bytes.size()), ignored);
  go_on();
}

void Line::say_no_more() {
  boost::system::error_code ignored;
  far_.shutdown(tcp::socket::shutdown_send, ignored);
  go_on();
}

void Line::hang_up() {
  far_.close();
  go_on();
}

void Line::go_on() {
  context_.restart();
  context_.poll();
}

std::vector<std::uint8_t> Line::heard() {
  std::vector<std::uint8_t> bytes(far_.available());
  boost::system::error_code ignored;
  bytes.resize(boost::asio::read(far_, boost::asio::buffer(bytes), ignored));
  return bytes;
}

std::vector<std::uint8_t> mended(Input stream) {
  std::vector<std::uint8_t> bytes(stream.begin(), stream.end());
  mend(bytes);
  return bytes;
}

}  // namespace irdm::fuzz
