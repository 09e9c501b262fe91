#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "common/wire/connection.hpp"
#include "tests/fuzz/harness.hpp"

namespace irdm::fuzz {

/// A connection whose far end the fuzzer has, and whose near end lives on a thread that runs only
/// while the fuzzer says something.
class Line {
 public:
  enum class Kind {
    kPair,      ///< no addresses, and no ports that so many of them would use up
    kLoopback,  ///< TCP: for what asks for addresses
  };
  explicit Line(Kind kind = Kind::kPair);

  /// The near end, once.
  std::shared_ptr<wire::Connection> connection();
  boost::asio::any_io_executor executor() { return context_.get_executor(); }
  void say(Input bytes);
  void say_no_more();
  void hang_up();
  /// The near end does what it has to.
  void go_on();
  /// What the near end has said since the last call.
  std::vector<std::uint8_t> heard();

 private:
  void connect(boost::asio::ip::tcp::acceptor&& acceptor);

  boost::asio::io_context context_;
  boost::asio::ip::tcp::socket near_{context_};
  boost::asio::ip::tcp::socket far_{context_};
};

/// The stream with the right checksums.
std::vector<std::uint8_t> mended(Input stream);

constexpr std::int64_t kFarFutureNs = std::int64_t{1} << 60;

}  // namespace irdm::fuzz
