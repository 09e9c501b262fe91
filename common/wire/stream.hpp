#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "common/wire/asio.hpp"
#include "common/wire/message.hpp"
#include "common/wire/secret_key.hpp"

namespace irdm::wire {

/// Whether a message is of those that replace one another and may go by datagrams: samples, forces,
/// contact models, applied forces.
bool is_of_stream(const Message& message) noexcept;

/// Lets through what is newer than all of its kind and stylus before, by the number of its frame:
/// datagrams overtake one another, and what went by TCP. Pure.
class StreamOrder {
 public:
  /// False: it is late and nobody should see it.
  bool take(const Frame& frame) noexcept;

 private:
  static constexpr std::size_t kKinds = 4;
  static constexpr std::size_t kStyluses = 64;  ///< as many slots as a server can have
  std::array<std::array<std::optional<std::uint64_t>, kStyluses>, kKinds> newest_{};  ///< numbers
};

/// The bytes of a connection over a TCP socket, as they are or in TLS. On the thread of its
/// io_context. One read and one write may be under way at a time; who waits keeps it alive.
class Stream {
 public:
  using Error = boost::system::error_code;

  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  virtual ~Stream() = default;

  virtual boost::asio::ip::tcp::socket& socket() = 0;
  /// Comes before all else.
  virtual void handshake(std::function<void(Error)> done) = 0;
  virtual void read_some(boost::asio::mutable_buffer bytes,
                         std::function<void(Error, std::size_t)> done) = 0;
  virtual void write(boost::asio::const_buffer bytes, std::function<void(Error)> done) = 0;
  /// Keys for something beside these bytes, the same at both ends: in TLS by its exporter, so that
  /// nobody else has them; of bytes as they are, `random` itself. After the handshake. Throws
  /// std::runtime_error when OpenSSL does not play along.
  /// @param random of this session, sent over the stream
  virtual KeyMaterial derive(std::string_view label, const KeyMaterial& random) = 0;
};

/// Bytes as they are; the handshake is done at once.
std::unique_ptr<Stream> make_plain_stream(boost::asio::ip::tcp::socket socket);

}  // namespace irdm::wire
