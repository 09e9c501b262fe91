// What a disk is good for: a fingertip of 1.5 cm presses a fixed depth into a face of a model whose
// columns come from its file, and slides to and fro at several speeds, or taps here and there, in
// real time. Beside it, in the same steps, the modal engine, which misses nothing. First with
// nothing of the file in the system's memory, then with as much of it as the run before left there.
//   bench_streamed_columns MODEL.h5 MEBIBYTES      a model with storage = "both"
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <random>

#include "bench/report.hpp"
#include "common/model/model_file.hpp"
#include "common/realtime/clock.hpp"
#include "common/realtime/histogram.hpp"
#include "scene/columns/column_store.hpp"
#include "simulation/step/simulation.hpp"

using namespace irdm;

namespace {

constexpr double kDuration = 6.0;  // [s]
constexpr double kRadius = 0.015;
constexpr double kDepth = 0.006;

struct Sliding {
  double half_edge;
  double speed;
  std::string name() const {
    return "slides at " + std::to_string(std::lround(100.0 * speed)) + " cm/s";
  }
  // Down within 0.3 s, then a triangle wave over 8 cm.
  Vector3 tip(double t) const {
    const double way = std::max(0.0, t - 0.3) * speed;
    const double along = std::abs(std::fmod(way + 0.04, 0.16) - 0.08) - 0.04;
    const double down = std::min(1.0, t / 0.3);
    return {along, half_edge + 0.003 - (0.003 + kDepth) * down * down * (3 - 2 * down), 0.01};
  }
};

// Taps at random places, so many a second: a quarter of the time to get there, then down and up.
struct Tapping {
  double half_edge;
  double rate;
  std::string name() const { return std::to_string(std::lround(rate)) + " taps a second"; }
  static Vector3 place(int number) {
    std::mt19937 random(static_cast<unsigned>(number + 1));
    std::uniform_real_distribution<double> uniform(-0.045, 0.045);
    const double x = uniform(random);
    return {x, 0.0, uniform(random)};
  }
  Vector3 tip(double t) const {
    const auto number = static_cast<int>(t * rate);
    const double phase = t * rate - number;
    const double there = std::min(1.0, 4.0 * phase);
    const double down = std::sin(std::numbers::pi * std::max(0.0, (phase - 0.25) / 0.75));
    return (1.0 - there) * place(number - 1) + there * place(number) +
           Vector3(0.0, half_edge + 0.005 - (0.005 + kDepth) * down * down, 0.0);
  }
};

SimulationConfig config_of(const std::shared_ptr<const Model>& model) {
  SimulationConfig config;
  config.objects.resize(1);
  config.objects[0].model = model;
  config.objects[0].tether = {1000.0, 10.0};
  config.objects[0].damping = {20.0, 20.0};
  config.styluses = {{kRadius, 2000.0, 0.0}};
  return config;
}

void forget(const std::string& path) {
  const int file = ::open(path.c_str(), O_RDONLY);
  ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
  ::close(file);
}

double seconds_since(std::int64_t begin) {
  return static_cast<double>(monotonic_ns() - begin) * 1e-9;
}

template <typename Motion>
void feel(bench::Report& report, const std::string& where, const Motion& motion,
          const std::shared_ptr<const Model>& streamed, const std::shared_ptr<const Model>& modal,
          const SceneColumns& columns) {
  Simulation simulation(config_of(streamed));
  Simulation reference(config_of(modal));
  StepRecord record;
  StepRecord expected;
  Histogram step_time;
  std::vector<double> errors;
  double peak = 0.0;
  const std::uint64_t loaded = columns.loaded();
  const auto period = static_cast<std::int64_t>(1e9 * simulation.dt());
  const std::int64_t start = monotonic_ns();
  for (int k = 0; k < static_cast<int>(kDuration / simulation.dt()); ++k) {
    sleep_until(start + k * period);
    const StylusCommand command{true, 0, motion.tip(k * simulation.dt()), {}};
    const std::int64_t begin = monotonic_ns();
    simulation.step({&command, 1}, record);
    step_time.add(monotonic_ns() - begin);
    reference.step({&command, 1}, expected);
    peak = std::max(peak, expected.stylus[0].force.norm());
    errors.push_back((record.stylus[0].force - expected.stylus[0].force).norm());
  }
  std::sort(errors.begin(), errors.end());
  const auto share = [&](double quantile) {
    return 100.0 *
           errors[static_cast<std::size_t>(quantile * static_cast<double>(errors.size() - 1))] /
           peak;
  };
  report.row({where, motion.name(), static_cast<double>(columns.loaded() - loaded) / kDuration,
              static_cast<double>(simulation.cache_misses()), share(0.5), share(0.99), share(1.0),
              static_cast<double>(step_time.percentile(0.5)) / 1e3,
              static_cast<double>(step_time.percentile(0.99)) / 1e3});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: bench_streamed_columns MODEL.h5 MEBIBYTES\n";
    return 2;
  }
  const std::string path = argv[1];
  SceneColumns columns(false);
  const std::int64_t begin = monotonic_ns();
  const auto streamed = std::make_shared<const Model>(
      columns.read(path, static_cast<std::size_t>(std::atof(argv[2]) * 1048576.0)));
  const auto modal = std::make_shared<const Model>(read_model(path, ResponseKind::kModal));
  std::cout << streamed->mesh.surface_node_count() << " surface nodes, start "
            << seconds_since(begin) << " s\n";
  columns.start(false);
  bench::Report report("streamed_columns");
  report.table("columns from the disk",
               {"file", "fingertip", "nodes read a second", "nodes missed",
                "force error, median [%]", "p99 [%]", "max [%]", "step, median [us]", "p99 [us]"});
  const double half_edge = streamed->mesh.nodes.col(1).maxCoeff();
  for (const std::string where : {"on disk", "in the system's memory"}) {
    for (const double speed : {0.01, 0.03, 0.1, 0.3}) {
      if (where == "on disk") forget(path);
      feel(report, where, Sliding{half_edge, speed}, streamed, modal, columns);
    }
    for (const double rate : {1.0, 3.0, 8.0}) {
      if (where == "on disk") forget(path);
      feel(report, where, Tapping{half_edge, rate}, streamed, modal, columns);
    }
  }
}
