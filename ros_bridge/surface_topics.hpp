#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ros_bridge/stylus_topics.hpp"
#include "ros_bridge/viewer_client.hpp"

namespace irdm::ros {

/// Publishes what viewers see: of each object its pose and surface nodes, of each stylus that is
/// led from here its tip.
class SurfaceTopics {
 public:
  using Styluses = std::vector<std::unique_ptr<StylusTopics>>;

  /// @param participant, styluses stay as long as this
  SurfaceTopics(const Participant& participant, const std::string& frame_id,
                const ServerAddress& viewer, const std::string& token, const Styluses& styluses);

 private:
  struct ObjectTopics {
    Endpoint pose;
    Endpoint points;
  };

  void begin(const viewer::Scene& scene);
  void publish(const SurfaceFrame& frame);

  const Participant& participant_;
  const std::string frame_id_;
  const Styluses& styluses_;
  std::vector<ObjectTopics> topics_;  ///< of each object, and of more when there were more
  std::vector<Points> rest_;          ///< X (n, 3) [m], B, of each object
  std::vector<std::uint8_t> bytes_;
  ViewerClient client_;  ///< ends first
};

}  // namespace irdm::ros
