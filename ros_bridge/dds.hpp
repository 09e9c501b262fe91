#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <string>

namespace irdm::ros {

/// A writer or a reader of a topic; its participant owns it. Any thread.
class Endpoint {
 public:
  explicit Endpoint(dds_entity_t handle) noexcept : handle_(handle) {}

  /// Of a writer. A message that DDS does not take is lost.
  /// @param message of the topic's type
  void write(const void* message) const noexcept { dds_write(handle_, message); }

  /// Of a reader: calls `use(const Message&)` with each message that has come.
  template <typename Message, typename Use>
  void take(const Use& use) const {
    for (;;) {
      void* sample = nullptr;  // lent by DDS
      dds_sample_info_t info{};
      if (dds_take(handle_, &sample, &info, 1, 1) <= 0) return;
      if (info.valid_data) use(*static_cast<const Message*>(sample));
      dds_return_loan(handle_, &sample, 1);
    }
  }

 private:
  dds_entity_t handle_;
};

/// Who may be a participant beside ours.
enum class Reach {
  kThisMachine,  ///< loopback interface, no multicast; CYCLONEDDS_URI is not read
  kNetwork,      ///< as Cyclone DDS and CYCLONEDDS_URI have it
};

/// A DDS participant whose topics are named as ROS 2 names them. Any thread.
class Participant {
 public:
  /// Throws Error.
  /// @param domain ROS_DOMAIN_ID  @param name_space of all topics, "irdm" say
  Participant(std::uint32_t domain, const std::string& name_space, Reach reach);
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  ~Participant();

  /// Reliable, volatile, the last 10: found by readers of any usual quality of service. Throws
  /// Error.
  /// @param name of the topic in the name space
  Endpoint writer(const dds_topic_descriptor_t& type, const std::string& name) const;
  /// Volatile, the newest message only. Throws Error.
  /// @param reliable false: takes from reliable and from best-effort writers
  Endpoint reader(const dds_topic_descriptor_t& type, const std::string& name, bool reliable) const;

  /// A topic as ROS 2's tools call it: /NAME_SPACE/NAME.
  std::string full_name(const std::string& name) const { return '/' + name_space_ + '/' + name; }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const;

  dds_entity_t domain_;  ///< 0: as it is by default
  dds_entity_t handle_;
  std::string name_space_;
};

}  // namespace irdm::ros
