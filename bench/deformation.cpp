// How fast the deformation thread reads the responses, beside what the machine's memory gives when
// it is only read, with the same threads: the two alternate, and the share is the median of the
// pairs. On a busy machine the share by processor time says more: it does not count waiting for a
// processor. Contacts move on from frame to frame, so that nothing is read again out of a cache.
#include <omp.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/machine.hpp"
#include "bench/report.hpp"
#include "bench/sparse_resident.hpp"
#include "bench/statistics.hpp"
#include "common/program/program.hpp"
#include "simulation/engine/response_engine.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

constexpr int kSteps = 500;
constexpr int kPairs = 9;
constexpr std::size_t kArray = std::size_t{1} << 30;  // bytes
constexpr double kMoved = 8e8;                        // bytes that the frames of a pair read

/// Frames that follow one another and have nothing in common.
struct Frames {
  std::string engine;
  int nodes = 0;
  double bytes = 0.0;  ///< of a frame
  int count = 0;
  std::function<bench::Elapsed(int)> time;  ///< of frame i
};

/// Three nodes that no other frame has.
std::vector<int> contact(int frame) {
  return {3 * frame, 3 * frame + 1, 3 * frame + 2};
}

template <typename Scalar>
Frames dense_frames(const std::string& name, int cells) {
  Model model = test::synthetic_cube(cells, 1, kSteps);
  Frames frames;
  frames.engine = name;
  frames.nodes = model.mesh.surface_node_count();
  frames.bytes = 9.0 * model.degrees_of_freedom() * kSteps * sizeof(Scalar);
  frames.count = std::min(frames.nodes / 3, static_cast<int>(kMoved / frames.bytes) + 1);
  std::vector<int> nodes;
  for (int i = 0; i < 3 * frames.count; ++i) nodes.push_back(i);
  model.response = bench::sparse_resident<Scalar>(model.degrees_of_freedom(), kSteps, nodes);
  const std::shared_ptr<ResponseEngine> engine =
      make_engine(std::make_shared<const Model>(std::move(model)));
  frames.time = [engine, u = Points()](int frame) mutable {
    engine->reset();
    std::vector<NodalForce> forces;
    for (const int node : contact(frame)) forces.push_back({node, Vector3(0.1, 0.2, 0.3)});
    for (int k = 0; k < kSteps; ++k) engine->advance(forces);
    return bench::elapsed([&] { engine->displacement(u); });
  };
  return frames;
}

/// With all modes moving.
template <typename Scalar>
Model modal_model(int cells, int modes) {
  Model model = test::synthetic_cube(cells, 1, kSteps);
  auto& response = std::get<ModalResponse>(model.response);
  response.angular_frequency = Eigen::VectorXd::LinSpaced(modes, 60.0, 600.0);
  response.decay_rate = Eigen::VectorXd::Constant(modes, 4.0);
  response.shapes.emplace<RowMatrix<Scalar>>(
      RowMatrix<Scalar>::Constant(model.degrees_of_freedom(), modes, Scalar(0.5)));
  return model;
}

std::shared_ptr<ResponseEngine> moved_engine(std::shared_ptr<const Model> model) {
  std::shared_ptr<ResponseEngine> engine = make_engine(std::move(model));
  const NodalForce force{1, Vector3(0.1, 0.2, 0.3)};
  engine->advance({&force, 1});
  return engine;
}

/// Several objects, one a frame.
template <typename Scalar>
Frames modal_frames(const std::string& name, int cells, int modes) {
  const Model plain = modal_model<Scalar>(cells, modes);
  Frames frames;
  frames.engine = name;
  frames.nodes = plain.mesh.surface_node_count();
  frames.bytes = static_cast<double>(plain.degrees_of_freedom()) * modes * sizeof(Scalar);
  frames.count = static_cast<int>(kMoved / frames.bytes) + 1;
  std::vector<std::shared_ptr<ResponseEngine>> engines;
  for (int i = 0; i < frames.count; ++i) {
    engines.push_back(moved_engine(std::make_shared<const Model>(plain)));
  }
  frames.time = [engines, u = Points()](int frame) mutable {
    return bench::elapsed([&] { engines[static_cast<std::size_t>(frame)]->displacement(u); });
  };
  return frames;
}

void measure(bench::Report& report, bench::Memory& memory, const Frames& frames) {
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    std::vector<double> read;
    std::vector<double> ours;
    std::vector<double> share;
    std::vector<double> share_of_cpu;
    for (int pair = 0; pair < kPairs; ++pair) {
      const bench::Elapsed reading = memory.read();
      bench::Elapsed frame_times;
      for (int i = 0; i < frames.count; ++i) frame_times += frames.time(i);
      const double bytes = frames.count * frames.bytes;
      read.push_back(memory.read_bytes() / reading.wall / 1e9);
      ours.push_back(bytes / frame_times.wall / 1e9);
      share.push_back(ours.back() / read.back());
      share_of_cpu.push_back(bytes / frame_times.cpu * reading.cpu / memory.read_bytes());
    }
    const double rate = bench::percentile(ours, 0.5);
    report.row({frames.engine, double(frames.nodes), double(threads), frames.bytes / 1e6,
                frames.bytes / rate / 1e6, rate, bench::percentile(read, 0.5),
                bench::percentile(share, 0.5), bench::percentile(share_of_cpu, 0.5)});
  }
}

/// Several objects of one model: their surfaces as one product, and one after the other.
void measure_together(bench::Report& report, int objects) {
  const auto model = std::make_shared<const Model>(modal_model<float>(12, 4050));
  std::vector<std::shared_ptr<ResponseEngine>> engines;
  std::vector<Points> surfaces(static_cast<std::size_t>(objects));
  std::vector<SurfaceRequest> requests;
  for (Points& u : surfaces) {
    engines.push_back(moved_engine(model));
    requests.push_back({engines.back().get(), 0.0, &u});
  }
  for (const int threads : {1, 2}) {
    omp_set_num_threads(threads);
    std::vector<double> apart;
    std::vector<double> together;
    std::vector<double> ratio;
    for (int pair = 0; pair < 20 * kPairs; ++pair) {
      apart.push_back(1e3 * bench::elapsed([&] {
                              for (std::size_t i = 0; i < engines.size(); ++i) {
                                engines[i]->displacement(surfaces[i]);
                              }
                            }).wall);
      together.push_back(1e3 * bench::elapsed([&] { displacements(requests); }).wall);
      ratio.push_back(together.back() / apart.back());
    }
    report.row({std::to_string(objects), double(threads), bench::percentile(apart, 0.5),
                bench::percentile(together, 0.5), bench::percentile(ratio, 0.5)});
  }
}

}  // namespace

int main(int, char** argv) {
  wait_passively_in_openmp(argv);  // as irdm-server does
  bench::Report report("deformation");
  bench::Memory memory(kArray);
  report.table(
      "deformed surface from a full history of one contact (3 nodes), T = 500; modal: 4050 modes",
      {"engine", "surface nodes", "threads", "read [MB]", "time [ms]", "rate [GB/s]",
       "memory, read [GB/s]", "share", "share, by processor time"});
  for (const int cells : {5, 8, 12, 24}) {
    measure(report, memory, dense_frames<float>("dense, single", cells));
  }
  for (const int cells : {12, 24}) {
    measure(report, memory, modal_frames<float>("modal, single", cells, 4050));
  }
  for (const int cells : {12, 24}) {
    measure(report, memory, modal_frames<double>("modal, double", cells, 4050));
  }
  report.table("surfaces of several objects of one model; modal, single, 866 nodes, 4050 modes",
               {"objects", "threads", "one after the other [ms]", "one product [ms]", "ratio"});
  for (const int objects : {1, 2, 4, 8}) measure_together(report, objects);
}
