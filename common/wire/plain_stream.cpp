#include <utility>

#include "common/wire/stream.hpp"

namespace irdm::wire {
namespace {

class PlainStream final : public Stream {
 public:
  explicit PlainStream(boost::asio::ip::tcp::socket socket) : socket_(std::move(socket)) {}

  boost::asio::ip::tcp::socket& socket() override { return socket_; }
  void handshake(std::function<void(Error)> done) override { done({}); }
  void read_some(boost::asio::mutable_buffer bytes,
                 std::function<void(Error, std::size_t)> done) override {
    socket_.async_read_some(boost::asio::buffer(bytes), std::move(done));
  }
  void write(boost::asio::const_buffer bytes, std::function<void(Error)> done) override {
    boost::asio::async_write(
        socket_, boost::asio::buffer(bytes),
        [done = std::move(done)](const Error& error, std::size_t) { done(error); });
  }
  KeyMaterial derive(std::string_view, const KeyMaterial& random) override { return random; }

 private:
  boost::asio::ip::tcp::socket socket_;
};

}  // namespace

std::unique_ptr<Stream> make_plain_stream(boost::asio::ip::tcp::socket socket) {
  return std::make_unique<PlainStream>(std::move(socket));
}

}  // namespace irdm::wire
