#include "device_bridge/haply/inverse_exchange.hpp"

#include <array>
#include <cstdio>

#include "common/realtime/clock.hpp"
#include "device_bridge/haply/inverse_opening.hpp"

namespace irdm::haply {

std::string InverseExchange::begin(const ExchangePartner& partner,
                                   const std::optional<InverseStatus>& status) {
  partner_ = partner;
  status_ = status;
  withhold();
  return partner.key == ForceKey::kVector ? encode_first(partner.device) : last();
}

std::optional<std::string> InverseExchange::next(std::int64_t now_ns) {
  if (sent_ns_.empty()) return encode_force(partner_.device, newest_force(now_ns), partner_.key);
  if (sent_ns_.size() > 1 || now_ns - sent_ns_.front() <= kLongestAgeNs) return std::nullopt;
  withhold();
  trouble_.tell("the service does not answer, no force; restart it");
  return last();
}

Vector3 InverseExchange::newest_force(std::int64_t now_ns) {
  mailbox_.force.receive();
  const InverseForce& newest = mailbox_.force.front();
  const bool usable = reading_.ready && newest.generation == reading_.generation &&
                      now_ns - newest.time_ns <= kLongestAgeNs;
  return usable ? newest.force : Vector3(Vector3::Zero());
}

void InverseExchange::answered(std::int64_t now_ns) {
  if (sent_ns_.empty()) return;
  const std::int64_t taken_ns = now_ns - sent_ns_.front();
  sent_ns_.pop_front();
  ++report_.answers;
  report_.sum += kNanosecond * static_cast<double>(taken_ns);
  report_.round_trip.add(taken_ns);
}

void InverseExchange::take(const InverseDevice& device, const std::vector<VerseGrip>& grips,
                           std::int64_t now_ns) {
  reading_.time_ns = now_ns;
  reading_.tip = *device.tip;
  const VerseGrip* grip =
      partner_.grip.empty() && !grips.empty() ? &grips.front() : find_by_id(grips, partner_.grip);
  reading_.buttons = grip != nullptr ? grip->buttons : 0;
  if (grip != nullptr && grip->orientation) reading_.orientation = *grip->orientation;
  if (device.status) status_ = device.status;
  judge();
  mailbox_.reading.put(reading_);
}

// What was not ready begins anew.
void InverseExchange::judge() {
  const InverseStatus status = status_.value_or(InverseStatus{});
  const bool ready = status.ready && status.calibrated && status.power_supply && !locked_;
  if (ready && !reading_.ready) ++reading_.generation;
  reading_.ready = ready;
  if (ready) return trouble_.tell("");
  if (locked_)
    return trouble_.tell(
        "its emergency brake is engaged, no force; release it (if it is: engage it and release it "
        "again)");
  if (!status.power_supply) return trouble_.tell("has no power supply, no force; plug it in");
  if (!status.calibrated) {
    return trouble_.tell(
        "is not calibrated, no force; rest the grip in its place until the light is "
        "steady");
  }
  trouble_.tell("is not ready, no force; look into Haply Hub");
}

void InverseExchange::withhold() {
  reading_.ready = false;
  mailbox_.reading.put(reading_);
}

void InverseExchange::lock(bool engaged) {
  locked_ = engaged;
  if (engaged) withhold();
}

std::string to_text(const InverseReport& report) {
  const double mean = report.answers > 0 ? report.sum / static_cast<double>(report.answers) : 0.0;
  std::array<char, 200> text{};
  std::snprintf(text.data(), text.size(),
                "%llu answers, round trip mean %.3f, p99 %.3f, max %.3f ms; %llu messages not "
                "understood, %llu reconnects",
                static_cast<unsigned long long>(report.answers), 1e3 * mean,
                1e-6 * static_cast<double>(report.round_trip.percentile(0.99)),
                1e-6 * static_cast<double>(report.round_trip.maximum()),
                static_cast<unsigned long long>(report.bad_messages),
                static_cast<unsigned long long>(report.reconnects));
  return text.data();
}

}  // namespace irdm::haply
