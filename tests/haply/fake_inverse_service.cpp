// A stand-in for Haply's Inverse Service 3.0 or 3.5, as a process of its own:
//
//     fake_inverse_service 3.0|3.5 PORT OLD_HTTP_PORT EVENTS_PORT DEVICE...
//
// A port 0 is any. It prints the ports that it listens on: of the service (WebSocket, and in 3.5
// HTTP), of the HTTP that 3.0 has on another one, of the events that 3.5 has (WebSocket), and of
// orders, a line each, which it answers with a line (FakeWorld::obey).
#include <sys/prctl.h>

#include <csignal>
#include <functional>
#include <iostream>
#include <memory>
#include <thread>

// Must come before Boost's own headers.
#include "common/wire/asio.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "tests/haply/fake_world.hpp"

namespace {

namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using irdm::test::FakeWorld;

using Request = http::request<http::string_body>;

void serve_http(FakeWorld& world, tcp::socket& socket, const Request& request) {
  const auto answer = world.answer_http(std::string(request.method_string()),
                                        std::string(request.target()), request.body());
  http::response<http::string_body> response(answer ? http::status::ok : http::status::not_found,
                                             request.version(), answer.value_or(""));
  response.prepare_payload();
  http::write(socket, response);
}

void serve_websocket(FakeWorld& world, tcp::socket socket, const Request& request) {
  websocket::stream<tcp::socket> stream(std::move(socket));
  stream.next_layer().set_option(tcp::no_delay(true));
  stream.accept(request);
  stream.text(true);
  stream.write(boost::asio::buffer(world.full_state()));
  beast::flat_buffer buffer;
  for (;;) {
    stream.read(buffer);
    const auto answer = world.answer(beast::buffers_to_string(buffer.cdata()));
    buffer.consume(buffer.size());
    if (world.delay().count() > 0) std::this_thread::sleep_for(world.delay());
    if (answer) stream.write(boost::asio::buffer(*answer));
  }
}

void serve_events(FakeWorld& world, tcp::socket socket) {
  websocket::stream<tcp::socket> stream(std::move(socket));
  stream.accept();
  stream.text(true);
  for (std::size_t number = world.listen();; ++number) {
    const std::string text = world.event(number);
    if (text.empty()) return;  // the channel breaks
    stream.write(boost::asio::buffer(text));
  }
}

void serve_web(FakeWorld& world, tcp::socket socket, bool takes_websocket, bool takes_http) {
  beast::flat_buffer buffer;
  Request request;
  http::read(socket, buffer, request);
  if (websocket::is_upgrade(request)) {
    if (takes_websocket) serve_websocket(world, std::move(socket), request);
  } else if (takes_http) {
    serve_http(world, socket, request);
  }
}

void take_orders(FakeWorld& world, tcp::socket socket) {
  std::string text;
  for (;;) {
    const std::size_t length =
        boost::asio::read_until(socket, boost::asio::dynamic_buffer(text), '\n');
    const std::string answer = world.obey(text.substr(0, length - 1)) + "\n";
    text.erase(0, length);
    boost::asio::write(socket, boost::asio::buffer(answer));
  }
}

/// Serves each connection in a thread of its own, which ends with it.
class Listener {
 public:
  Listener(boost::asio::io_context& io, unsigned short port, std::function<void(tcp::socket)> serve)
      : acceptor_(io, {boost::asio::ip::address_v4::loopback(), port}), serve_(std::move(serve)) {
    accept();
  }
  unsigned short port() { return acceptor_.local_endpoint().port(); }

 private:
  void accept() {
    acceptor_.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error) return;
      std::thread([serve = serve_, peer = std::make_shared<tcp::socket>(std::move(socket))] {
        try {
          serve(std::move(*peer));
        } catch (const std::exception&) {  // it is gone
        }
      }).detach();
      accept();
    });
  }
  tcp::acceptor acceptor_;
  std::function<void(tcp::socket)> serve_;
};

}  // namespace

int main(int count, char** words) {
  if (count < 5) {
    std::cerr << "usage: fake_inverse_service 3.0|3.5 PORT OLD_HTTP_PORT EVENTS_PORT DEVICE...\n";
    return 2;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a test that is killed leaves nothing behind
  const bool old = std::string(words[1]) == "3.0";
  FakeWorld world(old, std::vector<std::string>(words + 5, words + count));
  boost::asio::io_context io;
  const auto port = [&](int i) { return static_cast<unsigned short>(std::stoi(words[i])); };
  Listener service(io, port(2),
                   [&](tcp::socket socket) { serve_web(world, std::move(socket), true, !old); });
  Listener old_http(io, port(3),
                    [&](tcp::socket socket) { serve_web(world, std::move(socket), false, old); });
  Listener events(io, port(4), [&](tcp::socket socket) {
    if (!old) serve_events(world, std::move(socket));
  });
  Listener orders(io, 0, [&](tcp::socket socket) { take_orders(world, std::move(socket)); });
  std::cout << "ports " << service.port() << ' ' << old_http.port() << ' ' << events.port() << ' '
            << orders.port() << std::endl;
  io.run();
}
