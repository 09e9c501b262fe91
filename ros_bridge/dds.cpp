#include "ros_bridge/dds.hpp"

#include <memory>

#include "common/error.hpp"

namespace irdm::ros {
namespace {

// What a dds_create_... returned, unless it is an error code.
dds_entity_t made(dds_entity_t handle, const std::string& what) {
  if (handle >= 0) return handle;
  throw Error("DDS", "no " + what + ": " + dds_strretcode(handle),
              "check --domain and the network interfaces (CYCLONEDDS_URI)");
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Qos quality(bool reliable, int depth) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  constexpr dds_duration_t kLongestBlock = DDS_MSECS(100);
  const auto reliability = reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT;
  dds_qset_reliability(qos.get(), reliability, kLongestBlock);
  dds_qset_durability(qos.get(), DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

}  // namespace

Participant::Participant(std::uint32_t domain, const std::string& name_space)
    : handle_(made(dds_create_participant(domain, nullptr, nullptr), "participant")),
      name_space_(name_space) {}

dds_entity_t Participant::topic(const dds_topic_descriptor_t& type, const std::string& name) const {
  const std::string mangled = "rt" + full_name(name);
  return made(dds_create_topic(handle_, &type, mangled.c_str(), nullptr, nullptr),
              "topic " + mangled);
}

Endpoint Participant::writer(const dds_topic_descriptor_t& type, const std::string& name) const {
  const Qos qos = quality(true, 10);
  return Endpoint(made(dds_create_writer(handle_, topic(type, name), qos.get(), nullptr),
                       "writer of " + full_name(name)));
}

Endpoint Participant::reader(const dds_topic_descriptor_t& type, const std::string& name,
                             bool reliable) const {
  const Qos qos = quality(reliable, 1);
  return Endpoint(made(dds_create_reader(handle_, topic(type, name), qos.get(), nullptr),
                       "reader of " + full_name(name)));
}

}  // namespace irdm::ros
