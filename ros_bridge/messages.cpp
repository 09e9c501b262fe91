#include "ros_bridge/messages.hpp"

#include <array>
#include <bit>
#include <chrono>
#include <cstring>

#include "common/realtime/clock.hpp"

namespace irdm::ros {
namespace {

// Of sensor_msgs/msg/PointField.
constexpr std::uint8_t kFloat32 = 7;

sensor_msgs_msg_dds__PointField_ field(const char* name, std::uint32_t offset) noexcept {
  return {const_cast<char*>(name), offset, kFloat32, 1};
}

}  // namespace

Quaternion ros_to_world() noexcept {
  return {0.5, -0.5, 0.5, 0.5};
}

Header header(const std::string& frame_id, std::int64_t time_ns) noexcept {
  const std::int64_t now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                  std::chrono::system_clock::now().time_since_epoch())
                                  .count();
  const std::int64_t at_ns = now_ns - (monotonic_ns() - time_ns);
  return {{static_cast<std::int32_t>(at_ns / kNanosecondsPerSecond),
           static_cast<std::uint32_t>(at_ns % kNanosecondsPerSecond)},
          const_cast<char*>(frame_id.c_str())};
}

PoseMessage pose_message(const Header& header, const Vector3& position,
                         const Quaternion& orientation) noexcept {
  const Quaternion from_world = ros_to_world().conjugate();
  const Vector3 p = from_world * position;
  const Quaternion q = from_world * orientation;
  return {header, {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}}};
}

WrenchMessage wrench_message(const Header& header, const Vector3& force,
                             const Vector3& torque) noexcept {
  return {header, {{force.x(), force.y(), force.z()}, {torque.x(), torque.y(), torque.z()}}};
}

PointCloudMessage point_cloud_message(const Header& header, const Points& rest,
                                      const ObjectSurface& surface,
                                      std::vector<std::uint8_t>& bytes) {
  static std::array fields{field("x", 0), field("y", 4), field("z", 8)};
  using Floats = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  const Quaternion from_world = ros_to_world().conjugate();
  const Matrix3 turn = (from_world * surface.orientation).toRotationMatrix();
  const Vector3 centre = from_world * surface.position;
  const Floats points =
      (((rest + surface.displacement) * turn.transpose()).rowwise() + centre.transpose())
          .cast<float>();
  constexpr std::uint32_t kStep = 3 * sizeof(float);
  const auto count = static_cast<std::uint32_t>(points.rows());
  bytes.resize(count * kStep);
  std::memcpy(bytes.data(), points.data(), bytes.size());
  PointCloudMessage message{};
  message.header = header;
  message.height = 1;
  message.width = count;
  message.fields = {fields.size(), fields.size(), fields.data(), false};
  message.is_bigendian = std::endian::native == std::endian::big;
  message.point_step = kStep;
  message.row_step = count * kStep;
  message.data = {count * kStep, count * kStep, bytes.data(), false};
  message.is_dense = true;
  return message;
}

}  // namespace irdm::ros
