#include "tests/haply/fake_service.hpp"

#include <csignal>
#include <sstream>
#include <vector>

#include "common/wire/asio.hpp"

namespace irdm::test {

FakeService::FakeService(const std::string& version, const std::string& devices)
    : version_(version), devices_(devices) {
  start();
}

void FakeService::kill() {
  process_->signal(SIGKILL);
  process_->wait();
}

void FakeService::start() {
  std::vector<std::string> command{IRDM_FAKE_INVERSE_SERVICE, version_, std::to_string(port_),
                                   std::to_string(old_http_port_), std::to_string(events_port_)};
  std::istringstream ids(devices_);
  for (std::string id; ids >> id;) command.push_back(id);
  process_.reset();
  process_.emplace(command);
  std::istringstream words(process_->line_with("ports "));
  std::string word;
  words >> word >> port_ >> old_http_port_ >> events_port_ >> orders_port_;
}

std::string FakeService::order(const std::string& line) const {
  using boost::asio::ip::tcp;
  boost::asio::io_context io;
  tcp::socket socket(io);
  socket.connect({boost::asio::ip::address_v4::loopback(), orders_port_});
  boost::asio::write(socket, boost::asio::buffer(line + "\n"));
  std::string answer;
  boost::asio::read_until(socket, boost::asio::dynamic_buffer(answer), '\n');
  answer.pop_back();
  return answer;
}

FakeService::Told FakeService::told(const std::string& device) const {
  std::istringstream words(order("told " + device));
  Told told;
  words >> told.force.x() >> told.force.y() >> told.force.z() >> told.forces >> told.gravity >>
      told.largest;
  return told;
}

haply::InverseSettings FakeService::settings(const std::string& device) const {
  haply::InverseSettings settings;
  settings.service = {"127.0.0.1", port_};
  settings.old_http_port = old_http_port_;
  settings.events_port = events_port_;
  settings.device = device;
  return settings;
}

}  // namespace irdm::test
