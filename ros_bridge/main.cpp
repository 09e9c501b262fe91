#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/program/program.hpp"
#include "ros_bridge/ros_bridge.hpp"

int main(int argc, char** argv) {
  CLI::App app("Styluses and surfaces of a server as topics of ROS 2", "irdm-ros-bridge");
  const auto run = irdm::ros::add_options(app);
  return irdm::run_program(app, argc, argv, [&] {
    spdlog::set_default_logger(spdlog::stderr_color_mt("irdm-ros-bridge"));
    return run();
  });
}
