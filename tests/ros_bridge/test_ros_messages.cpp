#include <chrono>
#include <cstring>

#include "common/realtime/clock.hpp"
#include "ros_bridge/messages.hpp"
#include "tests/support/catch.hpp"

using namespace irdm;

TEST_CASE("ROS bridge: x of ROS is forward, y left, z up, to the bit") {
  const Quaternion turn = ros::ros_to_world();
  CHECK(turn * Vector3::UnitX() == Vector3(0, 0, -1));
  CHECK(turn * Vector3::UnitY() == Vector3(-1, 0, 0));
  CHECK(turn * Vector3::UnitZ() == Vector3(0, 1, 0));
}

TEST_CASE("ROS bridge: a pose, and points that lie where it puts them") {
  const std::string frame = "here";
  const Vector3 position(0.1, 0.2, 0.3);  // W: right, up, back
  const Quaternion up(Eigen::AngleAxisd(0.5, Vector3::UnitY()));
  const ros::PoseMessage pose = ros::pose_message(ros::header(frame, monotonic_ns()), position, up);
  CHECK(pose.header.frame_id == frame);
  const auto& p = pose.pose.position;
  const auto& q = pose.pose.orientation;
  CHECK((Vector3(p.x, p.y, p.z) - Vector3(-0.3, -0.1, 0.2)).norm() < 1e-15);

  Points rest(2, 3);
  rest << 0.01, 0.02, 0.03, -0.01, 0.0, 0.04;
  const Points displacement = Points::Constant(2, 3, 1e-3);
  const ObjectSurface surface{position, up, displacement};
  std::vector<std::uint8_t> bytes;
  const auto cloud = ros::point_cloud_message(pose.header, rest, surface, bytes);
  CHECK(cloud.width * cloud.height == 2);
  REQUIRE(cloud.data._length == 24);
  REQUIRE(cloud.fields._length == 3);
  CHECK(std::string(cloud.fields._buffer[2].name) == "z");
  CHECK(cloud.fields._buffer[2].offset == 8);
  for (int i = 0; i < 2; ++i) {
    // As a node of ROS would compute it from the pose.
    const Vector3 expected =
        Vector3(p.x, p.y, p.z) +
        Quaternion(q.w, q.x, q.y, q.z) * Vector3((rest + displacement).row(i).transpose());
    Eigen::Vector3f point;
    std::memcpy(point.data(), cloud.data._buffer + 12 * i, 12);
    CHECK((point.cast<double>() - expected).norm() < 1e-7);
  }
}

TEST_CASE("ROS bridge: a message's stamp is of the system clock") {
  const auto seconds = [](const ros::Header& header) {
    return header.stamp.sec + kNanosecond * header.stamp.nanosec;
  };
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  CHECK(seconds(ros::header("", monotonic_ns())) == Approx(now).margin(60.0).epsilon(0));
  CHECK(seconds(ros::header("", monotonic_ns() - 1'000 * kNanosecondsPerSecond)) ==
        Approx(now - 1000.0).margin(60.0).epsilon(0));
}
