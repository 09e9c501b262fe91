#include "ros_bridge/surface_topics.hpp"

#include <spdlog/spdlog.h>

#include "common/error.hpp"
#include "common/realtime/clock.hpp"

namespace irdm::ros {

SurfaceTopics::SurfaceTopics(const Participant& participant, const std::string& frame_id,
                             const ServerAddress& viewer, const std::string& token,
                             const Styluses& styluses)
    : participant_(participant),
      frame_id_(frame_id),
      styluses_(styluses),
      client_(viewer, token,
              {[this](const viewer::Scene& scene) { begin(scene); },
               [this](const SurfaceFrame& frame) { publish(frame); }}) {}

// Names of objects may have letters that names of topics cannot have.
void SurfaceTopics::begin(const viewer::Scene& scene) {
  rest_.clear();
  for (const viewer::SceneObject& object : scene.objects) {
    const std::string name = "object_" + std::to_string(rest_.size());
    rest_.push_back(object.rest);
    spdlog::info("{} is {}, {} surface nodes", participant_.full_name(name), in_quotes(object.name),
                 object.rest.rows());
    if (topics_.size() >= rest_.size()) continue;
    topics_.push_back(
        {participant_.writer(geometry_msgs_msg_dds__PoseStamped__desc, name + "/pose"),
         participant_.writer(sensor_msgs_msg_dds__PointCloud2__desc, name + "/points")});
  }
}

void SurfaceTopics::publish(const SurfaceFrame& frame) {
  const Header now = header(frame_id_, monotonic_ns());
  for (std::size_t i = 0; i < rest_.size(); ++i) {
    const ObjectSurface& surface = frame.objects[i];
    const PoseMessage pose = pose_message(now, surface.position, surface.orientation);
    topics_[i].pose.write(&pose);
    const PointCloudMessage points = point_cloud_message(now, rest_[i], surface, bytes_);
    topics_[i].points.write(&points);
  }
  for (const auto& stylus : styluses_) {
    const auto s = static_cast<std::size_t>(stylus->number());
    if (s < frame.styluses.size()) stylus->publish_tip(frame.styluses[s]);
  }
}

}  // namespace irdm::ros
