#include "common/wire/stream.hpp"

#include <optional>
#include <utility>

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

namespace {

struct Place {
  std::size_t kind = 0;
  std::size_t stylus = 0;
};

std::optional<Place> place_of(const Message& message) noexcept {
  if (const auto* sample = std::get_if<SampleMessage>(&message)) return Place{0, sample->stylus};
  if (const auto* force = std::get_if<ForceMessage>(&message)) return Place{1, force->stylus};
  if (const auto* model = std::get_if<ContactModelMessage>(&message)) {
    return Place{2, model->stylus};
  }
  if (const auto* applied = std::get_if<AppliedForcesMessage>(&message)) {
    return Place{3, applied->stylus};
  }
  return std::nullopt;
}

}  // namespace

bool is_of_stream(const Message& message) noexcept {
  return place_of(message).has_value();
}

// A stylus that no server has is for the session to refuse.
bool StreamOrder::take(const Frame& frame) noexcept {
  const std::optional<Place> place = place_of(frame.message);
  if (!place || place->stylus >= kStyluses) return true;
  std::optional<std::uint64_t>& newest = newest_[place->kind][place->stylus];
  if (newest && frame.header.sequence <= *newest) return false;
  newest = frame.header.sequence;
  return true;
}

}  // namespace irdm::wire
