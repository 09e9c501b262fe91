// How long one force step takes, and whether that depends on the object: cubes of growing size, one
// stylus that holds a point between three nodes, after T steps of history; and eight styluses.
//   modal, fixed     the same number of modes at every size
//   modal, all       as many modes as a cube of that size has
//   dense            R itself; of the largest only the columns of the nodes in contact are there,
//                    which is all that a force step reads (bench/sparse_resident.hpp)
// The responses are synthetic (random shapes): the time does not depend on the numbers.
//   bench_force_step [LARGEST CELLS AN EDGE]      58 (20186 surface nodes) unless given
#include <cmath>
#include <cstdlib>
#include <memory>

#include "bench/held_step.hpp"
#include "bench/report.hpp"
#include "bench/sparse_resident.hpp"
#include "tests/support/synthetic_model.hpp"

using namespace irdm;

namespace {

constexpr int kSteps = 500;  // T
constexpr int kFixedModes = 500;
constexpr int kMeasured = 4000;

// As TetGen fills the cube.
int all_modes(int cells) {
  return 3 * static_cast<int>(std::pow(cells + 1, 3) * 0.615) - 6;
}

std::shared_ptr<const Model> modal(int cells, int modes) {
  Model model = test::synthetic_cube(cells, modes, kSteps);
  auto& response = std::get<ModalResponse>(model.response);
  const RowMatrix<float> shapes = std::get<RowMatrix<double>>(response.shapes).cast<float>();
  response.shapes = shapes;
  return std::make_shared<const Model>(std::move(model));
}

template <typename Scalar>
std::shared_ptr<const Model> dense(int cells, int styluses) {
  Model model = test::synthetic_cube(cells, 1, kSteps);
  model.response = bench::sparse_resident<Scalar>(model.degrees_of_freedom(), kSteps,
                                                  bench::held_nodes(model, styluses));
  return std::make_shared<const Model>(std::move(model));
}

double gigabytes(int nodes, double number) {
  return 9.0 * nodes * nodes * kSteps * number / 1e9;
}

void add_row(bench::Report& report, const std::string& engine, int cells, double memory,
             const bench::StepTimes& times) {
  report.row({engine, double(6 * cells * cells + 2), memory, times.median, times.p99, times.p999});
}

}  // namespace

int main(int argc, char** argv) {
  const int largest = argc > 1 ? std::atoi(argv[1]) : 58;
  bench::Report report("force_step");
  const std::vector<std::string> columns{"engine",      "surface nodes", "response [GB]",
                                         "median [us]", "p99 [us]",      "p99.9 [us]"};
  report.table("force step, one held contact, T = 500", columns);
  for (const int cells : {5, 8, 12, 16, 20, 24, 36, 58}) {
    if (cells > largest) break;
    const int nodes = 6 * cells * cells + 2;
    const double dof = 3.0 * nodes;
    const auto add = [&](const std::string& engine, double memory,
                         const std::shared_ptr<const Model>& model) {
      add_row(report, engine, cells, memory, bench::held_steps(model, 1, kMeasured));
    };
    add("modal, 500 modes", dof * kFixedModes * sizeof(float) / 1e9, modal(cells, kFixedModes));
    if (cells <= 16) {
      add("modal, all modes", dof * all_modes(cells) * sizeof(float) / 1e9,
          modal(cells, all_modes(cells)));
    }
    add("dense, single", gigabytes(nodes, sizeof(float)), dense<float>(cells, 1));
  }
  constexpr int kPaper = 12;
  constexpr int kNodes = 6 * kPaper * kPaper + 2;
  const auto measure_several = [&](const std::string& name, int points, const auto& measure) {
    report.table(name, columns);
    const double dof = 3.0 * kNodes;
    add_row(report, "modal, 500 modes", kPaper, dof * kFixedModes * sizeof(float) / 1e9,
            measure(modal(kPaper, kFixedModes)));
    add_row(report, "modal, all modes", kPaper, dof * all_modes(kPaper) * sizeof(float) / 1e9,
            measure(modal(kPaper, all_modes(kPaper))));
    add_row(report, "dense, single", kPaper, gigabytes(kNodes, sizeof(float)),
            measure(dense<float>(kPaper, points)));
  };
  measure_several("force step, four held contacts, paper's cube", 4,
                  [](const auto& model) { return bench::held_steps(model, 4, kMeasured); });
  measure_several("eight coupled contacts: prediction, solution, history; paper's cube", 8,
                  [](const auto& model) { return bench::eight_contacts(model, kMeasured); });
}
