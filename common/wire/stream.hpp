#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string_view>

#include "common/wire/asio.hpp"
#include "common/wire/key_material.hpp"

namespace irdm::wire {

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
