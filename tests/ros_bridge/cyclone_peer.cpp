#include <dds/dds.h>
#include <ros_types.h>

#include <stdexcept>

#include "tests/ros_bridge/ros_peer.hpp"

namespace irdm::test {
namespace {

dds_entity_t made(dds_entity_t handle) {
  if (handle < 0) throw std::runtime_error(dds_strretcode(handle));
  return handle;
}

RosPose pose_of(const geometry_msgs_msg_dds__PoseStamped_& message) {
  const auto& [p, q] = message.pose;
  return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}, message.header.frame_id};
}

class CyclonePeer final : public RosPeer {
 public:
  CyclonePeer(std::uint32_t domain, const std::string& name_space)
      : domain_(made(dds_create_domain(domain, kLoopbackOnly))),
        participant_(made(dds_create_participant(domain, nullptr, nullptr))),
        prefix_("rt/" + name_space) {
    const auto& pose = geometry_msgs_msg_dds__PoseStamped__desc;
    command_ = writer(pose, "/stylus_0/command");
    grab_ = writer(std_msgs_msg_dds__Bool__desc, "/stylus_0/grab");
    wrench_ = reader(geometry_msgs_msg_dds__WrenchStamped__desc, "/stylus_0/wrench");
    tip_ = reader(pose, "/stylus_0/pose");
    body_ = reader(pose, "/object_0/pose");
    points_ = reader(sensor_msgs_msg_dds__PointCloud2__desc, "/object_0/points");
  }
  ~CyclonePeer() override {
    dds_delete(participant_);
    dds_delete(domain_);
  }

  void send_pose(const RosPose& pose) override {
    const auto& [p, q, frame] = pose;
    geometry_msgs_msg_dds__PoseStamped_ message{{{0, 0}, const_cast<char*>(frame.c_str())},
                                                {{p[0], p[1], p[2]}, {q[0], q[1], q[2], q[3]}}};
    made(dds_write(command_, &message));
  }
  void send_grab(bool down) override {
    const std_msgs_msg_dds__Bool_ message{down};
    made(dds_write(grab_, &message));
  }

  std::optional<RosWrench> wrench() override {
    return take<geometry_msgs_msg_dds__WrenchStamped_>(wrench_, [](const auto& message) {
      const auto& [f, t] = message.wrench;
      return RosWrench{{f.x, f.y, f.z}, {t.x, t.y, t.z}, message.header.frame_id};
    });
  }
  std::optional<RosPose> tip() override {
    return take<geometry_msgs_msg_dds__PoseStamped_>(tip_, pose_of);
  }
  std::optional<RosPose> body() override {
    return take<geometry_msgs_msg_dds__PoseStamped_>(body_, pose_of);
  }
  std::optional<RosCloud> points() override {
    return take<sensor_msgs_msg_dds__PointCloud2_>(points_, [](const auto& message) {
      RosCloud cloud{message.width, message.height, message.point_step, {}, {}};
      for (std::uint32_t i = 0; i < message.fields._length; ++i) {
        cloud.fields.emplace_back(message.fields._buffer[i].name);
      }
      cloud.data.assign(message.data._buffer, message.data._buffer + message.data._length);
      return cloud;
    });
  }

 private:
  dds_entity_t topic(const dds_topic_descriptor_t& type, const std::string& name) const {
    return made(dds_create_topic(participant_, &type, (prefix_ + name).c_str(), nullptr, nullptr));
  }
  dds_entity_t writer(const dds_topic_descriptor_t& type, const std::string& name) const {
    return made(dds_create_writer(participant_, topic(type, name), nullptr, nullptr));
  }
  // As `ros2 topic echo` asks at the least: best effort.
  dds_entity_t reader(const dds_topic_descriptor_t& type, const std::string& name) const {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1000);
    const dds_entity_t end = dds_create_reader(participant_, topic(type, name), qos, nullptr);
    dds_delete_qos(qos);
    return made(end);
  }
  template <typename Message, typename Convert>
  static auto take(dds_entity_t reader, Convert convert)
      -> std::optional<decltype(convert(std::declval<const Message&>()))> {
    void* sample = nullptr;
    dds_sample_info_t info{};
    if (dds_take(reader, &sample, &info, 1, 1) <= 0) return std::nullopt;
    std::optional<decltype(convert(std::declval<const Message&>()))> value;
    if (info.valid_data) value = convert(*static_cast<const Message*>(sample));
    dds_return_loan(reader, &sample, 1);
    return value;
  }

  dds_entity_t domain_;
  dds_entity_t participant_;
  std::string prefix_;
  dds_entity_t command_ = 0;
  dds_entity_t grab_ = 0;
  dds_entity_t wrench_ = 0;
  dds_entity_t tip_ = 0;
  dds_entity_t body_ = 0;
  dds_entity_t points_ = 0;
};

}  // namespace

std::unique_ptr<RosPeer> make_cyclone_peer(std::uint32_t domain, const std::string& name_space) {
  return std::make_unique<CyclonePeer>(domain, name_space);
}

}  // namespace irdm::test
