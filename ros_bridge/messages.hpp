#pragma once

#include <ros_types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry.hpp"
#include "simulation/deformation/deformation.hpp"

/// Values of irdm as messages of ROS 2. A message points to texts and arrays of its arguments, and
/// is good as long as these are.
namespace irdm::ros {

using Header = std_msgs_msg_dds__Header_;
using BoolMessage = std_msgs_msg_dds__Bool_;
using PoseMessage = geometry_msgs_msg_dds__PoseStamped_;
using WrenchMessage = geometry_msgs_msg_dds__WrenchStamped_;
using PointCloudMessage = sensor_msgs_msg_dds__PointCloud2_;

/// The frame of all messages in W: the same origin; x forward (-z of W), y left (-x), z up (y).
Quaternion ros_to_world() noexcept;

/// @param time_ns of this machine's monotonic clock; the message has the system clock's
Header header(const std::string& frame_id, std::int64_t time_ns) noexcept;

/// @param position [m], W  @param orientation to W
PoseMessage pose_message(const Header& header, const Vector3& position,
                         const Quaternion& orientation) noexcept;

/// @param force [N], in the frame of the messages  @param torque [N m], the same
WrenchMessage wrench_message(const Header& header, const Vector3& force,
                             const Vector3& torque) noexcept;

/// Surface nodes of an object: three float32 each, in the order of the model file.
/// @param rest positions X (n, 3) [m], B  @param bytes get the points
PointCloudMessage point_cloud_message(const Header& header, const Points& rest,
                                      const ObjectSurface& surface,
                                      std::vector<std::uint8_t>& bytes);

}  // namespace irdm::ros
