#include <ros_typesPubSubTypes.h>

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>
#include <stdexcept>

#include "tests/ros_bridge/ros_peer.hpp"

namespace irdm::test {
namespace {

namespace dds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
namespace geometry = geometry_msgs::msg::dds_;

dds::DomainParticipantQos loopback_only() {
  dds::DomainParticipantQos qos;
  auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.push_back("127.0.0.1");
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  rtps::Locator_t here;
  rtps::IPLocator::setIPv4(here, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(here);  // ports: those of the domain
  return qos;
}

RosPose pose_of(const geometry::PoseStamped_& message) {
  const auto& p = message.pose().position();
  const auto& q = message.pose().orientation();
  return {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}, message.header().frame_id()};
}

class FastPeer final : public RosPeer {
 public:
  FastPeer(std::uint32_t domain, const std::string& name_space)
      : participant_(dds::DomainParticipantFactory::get_instance()->create_participant(
            domain, loopback_only())),
        prefix_("rt/" + name_space) {
    if (participant_ == nullptr) throw std::runtime_error("no participant");
    publisher_ = participant_->create_publisher(dds::PUBLISHER_QOS_DEFAULT);
    subscriber_ = participant_->create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT);
    const std::string pose = add_type(new geometry::PoseStamped_PubSubType);
    command_ = writer(pose, "/stylus_0/command");
    grab_ = writer(add_type(new std_msgs::msg::dds_::Bool_PubSubType), "/stylus_0/grab");
    wrench_ = reader(add_type(new geometry::WrenchStamped_PubSubType), "/stylus_0/wrench");
    tip_ = reader(pose, "/stylus_0/pose");
    body_ = reader(pose, "/object_0/pose");
    points_ =
        reader(add_type(new sensor_msgs::msg::dds_::PointCloud2_PubSubType), "/object_0/points");
  }
  ~FastPeer() override {
    participant_->delete_contained_entities();
    dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }

  void send_pose(const RosPose& pose) override {
    geometry::PoseStamped_ message;
    message.header().frame_id(pose.frame_id);
    auto& p = message.pose().position();
    p.x(pose.position[0]);
    p.y(pose.position[1]);
    p.z(pose.position[2]);
    auto& q = message.pose().orientation();
    q.x(pose.orientation[0]);
    q.y(pose.orientation[1]);
    q.z(pose.orientation[2]);
    q.w(pose.orientation[3]);
    command_->write(&message);
  }
  void send_grab(bool down) override {
    std_msgs::msg::dds_::Bool_ message;
    message.data(down);
    grab_->write(&message);
  }

  std::optional<RosWrench> wrench() override {
    geometry::WrenchStamped_ message;
    if (!take(wrench_, message)) return std::nullopt;
    const auto& f = message.wrench().force();
    const auto& t = message.wrench().torque();
    return RosWrench{{f.x(), f.y(), f.z()}, {t.x(), t.y(), t.z()}, message.header().frame_id()};
  }
  std::optional<RosPose> tip() override { return take_pose(tip_); }
  std::optional<RosPose> body() override { return take_pose(body_); }
  std::optional<RosCloud> points() override {
    sensor_msgs::msg::dds_::PointCloud2_ message;
    if (!take(points_, message)) return std::nullopt;
    RosCloud cloud{message.width(), message.height(), message.point_step(), {}, message.data()};
    for (const auto& field : message.fields()) cloud.fields.push_back(field.name());
    return cloud;
  }

 private:
  std::string add_type(dds::TopicDataType* type) {
    const dds::TypeSupport support(type);
    support.register_type(participant_);
    return support.get_type_name();
  }
  dds::Topic* topic(const std::string& type, const std::string& name) {
    return participant_->create_topic(prefix_ + name, type, dds::TOPIC_QOS_DEFAULT);
  }
  dds::DataWriter* writer(const std::string& type, const std::string& name) {
    dds::DataWriter* made =
        publisher_->create_datawriter(topic(type, name), dds::DATAWRITER_QOS_DEFAULT);
    if (made == nullptr) throw std::runtime_error("no writer");
    return made;
  }
  // As rmw_fastrtps does by default.
  dds::DataReader* reader(const std::string& type, const std::string& name) {
    dds::DataReaderQos qos;
    qos.reliability().kind = dds::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 1000;
    dds::DataReader* made = subscriber_->create_datareader(topic(type, name), qos);
    if (made == nullptr) throw std::runtime_error("no reader");
    return made;
  }
  template <typename Message>
  static bool take(dds::DataReader* reader, Message& message) {
    dds::SampleInfo info;
    return reader->take_next_sample(&message, &info) ==
               eprosima::fastrtps::types::ReturnCode_t::RETCODE_OK &&
           info.valid_data;
  }
  static std::optional<RosPose> take_pose(dds::DataReader* reader) {
    geometry::PoseStamped_ message;
    if (!take(reader, message)) return std::nullopt;
    return pose_of(message);
  }

  dds::DomainParticipant* participant_;
  std::string prefix_;
  dds::Publisher* publisher_ = nullptr;
  dds::Subscriber* subscriber_ = nullptr;
  dds::DataWriter* command_ = nullptr;
  dds::DataWriter* grab_ = nullptr;
  dds::DataReader* wrench_ = nullptr;
  dds::DataReader* tip_ = nullptr;
  dds::DataReader* body_ = nullptr;
  dds::DataReader* points_ = nullptr;
};

}  // namespace

std::unique_ptr<RosPeer> make_fast_peer(std::uint32_t domain, const std::string& name_space) {
  return std::make_unique<FastPeer>(domain, name_space);
}

}  // namespace irdm::test
