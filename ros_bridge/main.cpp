#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/hdf5/handle.hpp"
#include "ros_bridge/ros_bridge.hpp"

int main(int argc, char** argv) {
  irdm::hdf5::leave_files_at_exit();
  spdlog::set_default_logger(spdlog::stderr_color_mt("irdm-ros-bridge"));
  return irdm::run_commands("irdm-ros-bridge",
                            "Styluses and surfaces of a server as topics of ROS 2", argc, argv,
                            irdm::ros::add_options, {});
}
