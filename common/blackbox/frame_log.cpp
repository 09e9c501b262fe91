#include "common/blackbox/frame_log.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "common/blackbox/row_log.hpp"
#include "common/realtime/clock.hpp"
#include "common/wire/bytes.hpp"
#include "common/wire/message.hpp"

namespace irdm {
namespace {

using wire::TapKind;

constexpr std::size_t kQueueBytes = 4 << 20;
constexpr std::size_t kMostBytes = 16 << 20;  // kept, whatever a peer sends

/// What the header of a frame says.
struct FrameHead {
  int type = 0;
  std::uint32_t session = 0;
  std::uint64_t sequence = 0;
};

// Zeros for what is no frame.
FrameHead head_of(TapKind kind, std::span<const std::uint8_t> bytes) {
  const bool frame = kind == TapKind::kReceived || kind == TapKind::kSent;
  if (!frame || bytes.size() < wire::kHeaderSize) return {};
  wire::ByteReader in(bytes.first(wire::kHeaderSize));
  FrameHead head;
  in.get<std::uint32_t>();  // magic
  in.get<std::uint16_t>();  // version
  head.type = in.get<std::uint16_t>();
  in.get<std::uint32_t>();  // size of the payload
  head.session = in.get<std::uint32_t>();
  head.sequence = in.get<std::uint64_t>();
  return head;
}

}  // namespace

FrameLog::FrameLog() : queue_(kQueueBytes) {}

std::uint32_t FrameLog::open(std::string_view peer) noexcept {
  ++connections_;
  see(TapKind::kOpened, connections_,
      {reinterpret_cast<const std::uint8_t*>(peer.data()), peer.size()});
  return connections_;
}

void FrameLog::see(TapKind kind, std::uint32_t connection,
                   std::span<const std::uint8_t> bytes) noexcept {
  const Head head{monotonic_ns(), connection, static_cast<std::uint32_t>(bytes.size()), kind};
  const auto raw = std::bit_cast<std::array<std::uint8_t, sizeof(Head)>>(head);
  if (queue_.write_available() < raw.size() + bytes.size()) {
    lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  queue_.push(raw.data(), raw.size());
  queue_.push(bytes.data(), bytes.size());
}

bool FrameLog::pop(Entry& entry) {
  if (!begun_) {
    std::array<std::uint8_t, sizeof(Head)> raw;
    if (queue_.read_available() < raw.size()) return false;
    queue_.pop(raw.data(), raw.size());
    begun_ = std::bit_cast<Head>(raw);
  }
  if (queue_.read_available() < begun_->size) return false;
  entry.head = *begun_;
  entry.bytes.resize(begun_->size);
  queue_.pop(entry.bytes.data(), entry.bytes.size());
  begun_.reset();
  return true;
}

std::optional<Fault> FrameLog::take() {
  std::optional<Fault> first;
  Entry entry;
  while (pop(entry)) {
    if (entry.head.kind == TapKind::kViolation && !first) {
      first = {.time_ns = entry.head.time_ns,
               .kind = "protocol violation",
               .detail = {entry.bytes.begin(), entry.bytes.end()}};
    }
    keep(std::move(entry));
  }
  return first;
}

void FrameLog::keep(Entry entry) {
  kept_bytes_ += sizeof(Entry) + entry.bytes.size();
  entries_.push_back(std::move(entry));
  while (kept_bytes_ > kMostBytes) drop_oldest();
}

void FrameLog::drop_oldest() {
  kept_bytes_ -= sizeof(Entry) + entries_.front().bytes.size();
  entries_.pop_front();
}

void FrameLog::forget(std::int64_t now_ns) {
  if (entries_.empty()) return;
  const std::int64_t end_ns = std::min(now_ns, entries_.back().head.time_ns);
  while (end_ns - entries_.front().head.time_ns > kKeptNs) drop_oldest();
}

void FrameLog::write(hdf5::File& file, std::int64_t origin_ns) const {
  std::vector<const Entry*> rows;
  std::vector<std::uint8_t> bytes;
  for (const Entry& entry : entries_) {
    rows.push_back(&entry);
    bytes.insert(bytes.end(), entry.bytes.begin(), entry.bytes.end());
  }
  const auto head = [](const Entry& entry) { return head_of(entry.head.kind, entry.bytes); };
  ColumnGroup<Entry> columns(file, "/frame", std::move(rows));
  columns.time("time", origin_ns, [](const Entry& entry) { return entry.head.time_ns; });
  columns.number<std::uint8_t>("kind", "", [](const Entry& entry) { return entry.head.kind; });
  columns.number<std::int32_t>("connection", "",
                               [](const Entry& entry) { return entry.head.connection; });
  columns.number<std::int32_t>("type", "", [&](const Entry& entry) { return head(entry).type; });
  columns.number<std::uint64_t>("session", "",
                                [&](const Entry& entry) { return head(entry).session; });
  columns.number<std::uint64_t>("sequence", "",
                                [&](const Entry& entry) { return head(entry).sequence; });
  columns.number<std::int32_t>("size", "byte", [](const Entry& entry) { return entry.head.size; });
  file.write<std::uint8_t>("/frame/bytes", {bytes.size()}, bytes.data());
  file.write_attribute("/frame", "lost", static_cast<std::int64_t>(lost_.load()));
}

}  // namespace irdm
