#include "device_bridge/haply/http_request.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>

namespace irdm::haply {
namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;

/// One exchange; what fails ends it.
class Exchange {
 public:
  explicit Exchange(http::request<http::string_body> request) : request_(std::move(request)) {}

  std::optional<std::string> run(const boost::asio::ip::tcp::endpoint& to) {
    constexpr std::chrono::seconds kPatience(1);
    stream_.async_connect(to, [this](ErrorCode error) { write(error); });
    io_.run_for(kPatience);
    return answer_;
  }

 private:
  using ErrorCode = beast::error_code;

  void write(ErrorCode error) {
    if (error) return;
    http::async_write(stream_, request_, [this](ErrorCode e, std::size_t) { read(e); });
  }
  void read(ErrorCode error) {
    if (error) return;
    http::async_read(stream_, buffer_, response_, [this](ErrorCode e, std::size_t) {
      if (!e && response_.result() == http::status::ok) answer_ = response_.body();
    });
  }

  http::request<http::string_body> request_;
  boost::asio::io_context io_;
  beast::tcp_stream stream_{io_};
  beast::flat_buffer buffer_;
  http::response<http::string_body> response_;
  std::optional<std::string> answer_;
};

}  // namespace

std::string host_text(const ServerAddress& address) {
  const bool numeric6 = address.host.find(':') != std::string::npos;
  return (numeric6 ? '[' + address.host + ']' : address.host) + ':' + std::to_string(address.port);
}

std::optional<std::string> http_request(const boost::asio::ip::address& at,
                                        const ServerAddress& address, http::verb verb,
                                        const std::string& target, const std::string& body) {
  constexpr unsigned kHttp11 = 11;
  http::request<http::string_body> request(verb, target, kHttp11, body);
  request.set(http::field::host, host_text(address));
  request.set(http::field::connection, "close");
  if (!body.empty()) request.set(http::field::content_type, "application/json");
  request.prepare_payload();
  return Exchange(std::move(request)).run({at, address.port});
}

}  // namespace irdm::haply
