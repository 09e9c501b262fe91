#include "common/wire/tls.hpp"

#include <openssl/crypto.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <boost/asio/ssl.hpp>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace irdm::wire {
namespace {

using boost::asio::ip::tcp;
namespace ssl = boost::asio::ssl;

// Both with SHA-256, which goes with the key.
constexpr const char* kCiphers = "TLS_AES_128_GCM_SHA256:TLS_CHACHA20_POLY1305_SHA256";
constexpr std::string_view kIdentity = "irdm";  // there is but one key

/// Where a context of OpenSSL keeps its key.
int key_index() {
  static const int index = SSL_CTX_get_ex_new_index(0, nullptr, nullptr, nullptr, nullptr);
  return index;
}

/// The key as OpenSSL wants it; null when it does not.
SSL_SESSION* session_of(SSL* connection) {
  const auto* key =
      static_cast<const SecretKey*>(SSL_CTX_get_ex_data(SSL_get_SSL_CTX(connection), key_index()));
  constexpr unsigned char kAes128GcmSha256[] = {0x13, 0x01};
  const SSL_CIPHER* cipher = SSL_CIPHER_find(connection, kAes128GcmSha256);
  SSL_SESSION* session = SSL_SESSION_new();
  if (session != nullptr && key != nullptr && cipher != nullptr &&
      SSL_SESSION_set1_master_key(session, key->data(), key->size()) == 1 &&
      SSL_SESSION_set_cipher(session, cipher) == 1 &&
      SSL_SESSION_set_protocol_version(session, TLS1_3_VERSION) == 1) {
    return session;
  }
  SSL_SESSION_free(session);
  return nullptr;
}

int find_session(SSL* connection, const unsigned char* identity, std::size_t size,
                 SSL_SESSION** session) {
  const bool ours = std::equal(identity, identity + size, kIdentity.begin(), kIdentity.end());
  *session = ours ? session_of(connection) : nullptr;
  return ours && *session == nullptr ? 0 : 1;
}

int use_session(SSL* connection, const EVP_MD*, const unsigned char** identity, std::size_t* size,
                SSL_SESSION** session) {
  *identity = reinterpret_cast<const unsigned char*>(kIdentity.data());
  *size = kIdentity.size();
  *session = session_of(connection);
  return *session != nullptr ? 1 : 0;
}

class TlsStream final : public Stream {
 public:
  TlsStream(tcp::socket socket, ssl::context& context, TlsRole role)
      : stream_(std::move(socket), context), role_(role) {}

  tcp::socket& socket() override { return stream_.next_layer(); }
  void handshake(std::function<void(Error)> done) override {
    const auto side =
        role_ == TlsRole::kServer ? ssl::stream_base::server : ssl::stream_base::client;
    stream_.async_handshake(side, [this, done = std::move(done)](const Error& error) {
      // No certificates are there, so that there is no other way in; this makes sure.
      const bool key_used = SSL_session_reused(stream_.native_handle()) == 1;
      done(error || key_used ? error : Error(ssl::error::unexpected_result));
    });
  }
  void read_some(boost::asio::mutable_buffer bytes,
                 std::function<void(Error, std::size_t)> done) override {
    stream_.async_read_some(boost::asio::buffer(bytes), std::move(done));
  }
  void write(boost::asio::const_buffer bytes, std::function<void(Error)> done) override {
    boost::asio::async_write(
        stream_, boost::asio::buffer(bytes),
        [done = std::move(done)](const Error& error, std::size_t) { done(error); });
  }
  KeyMaterial derive(std::string_view label, const KeyMaterial& random) override {
    KeyMaterial keys;
    constexpr int kWithContext = 1;
    if (SSL_export_keying_material(stream_.native_handle(), keys.data(), keys.size(), label.data(),
                                   label.size(), random.data(), random.size(), kWithContext) != 1) {
      throw std::runtime_error("OpenSSL exports no keys");
    }
    return keys;
  }

 private:
  ssl::stream<tcp::socket> stream_;
  TlsRole role_;
};

}  // namespace

struct Tls::Context {
  Context(TlsRole its_role, const SecretKey& its_key)
      : role(its_role), key(its_key), context(ssl::context::tls) {}
  ~Context() { OPENSSL_cleanse(key.data(), key.size()); }

  TlsRole role;
  SecretKey key;
  ssl::context context;
};

Tls::Tls(TlsRole role, const SecretKey& key) : context_(std::make_unique<Context>(role, key)) {
  SSL_CTX* native = context_->context.native_handle();
  const bool good = SSL_CTX_set_min_proto_version(native, TLS1_3_VERSION) == 1 &&
                    SSL_CTX_set_ciphersuites(native, kCiphers) == 1 &&
                    SSL_CTX_set_num_tickets(native, 0) == 1 &&
                    SSL_CTX_set_ex_data(native, key_index(), &context_->key) == 1;
  if (!good) throw std::runtime_error("OpenSSL cannot speak TLS 1.3");
  SSL_CTX_set_session_cache_mode(native, SSL_SESS_CACHE_OFF);
  if (role == TlsRole::kServer) {
    SSL_CTX_set_psk_find_session_callback(native, find_session);
  } else {
    SSL_CTX_set_psk_use_session_callback(native, use_session);
    SSL_CTX_set_verify(native, SSL_VERIFY_PEER, nullptr);
  }
}

Tls::~Tls() = default;

std::unique_ptr<Stream> Tls::make_stream(tcp::socket socket) {
  return std::make_unique<TlsStream>(std::move(socket), context_->context, context_->role);
}

bool is_tls_failure(const boost::system::error_code& error) {
  return error.category() == boost::asio::error::get_ssl_category() ||
         error == ssl::error::unexpected_result;
}

}  // namespace irdm::wire
