#pragma once

#include <memory>

#include "common/wire/secret_key.hpp"
#include "common/wire/stream.hpp"

namespace irdm::wire {

enum class TlsRole { kServer, kClient };

/// TLS 1.3, and nothing older, between two who know the same key: it proves each to the other, in
/// place of certificates, and a fresh exchange of keys in each handshake keeps what was said before
/// secret when it becomes known later. No session is resumed and nothing is sent early, so nothing
/// can be replayed.
class Tls {
 public:
  /// Throws std::runtime_error when OpenSSL does not play along.
  Tls(TlsRole role, const SecretKey& key);
  Tls(const Tls&) = delete;
  Tls& operator=(const Tls&) = delete;
  ~Tls();

  /// Its handshake fails when the other side has another key or speaks no TLS. The stream must not
  /// outlive this object.
  std::unique_ptr<Stream> make_stream(boost::asio::ip::tcp::socket socket);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

/// Whether TLS itself failed: another key, or no TLS at the other end. False for errors of the
/// network.
bool is_tls_failure(const boost::system::error_code& error);

}  // namespace irdm::wire
