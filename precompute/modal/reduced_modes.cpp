#include "precompute/modal/reduced_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/error.hpp"
#include "precompute/blas.hpp"
#include "precompute/modal/driving_spectrum.hpp"
#include "precompute/modal/elastic_statics.hpp"
#include "precompute/modal/fingertip.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/residual_compliance.hpp"

namespace irdm::precompute {
namespace {

constexpr int kFirstTry = 64;

// Of the fastest shear wave in an element at the surface [m/s]: the residual is of surface nodes
// near each other.
double surface_shear_speed(const Model& model) {
  std::vector<bool> at_surface(static_cast<std::size_t>(model.mesh.nodes.rows()), false);
  for (const int node : model.mesh.surface_nodes) at_surface[static_cast<std::size_t>(node)] = true;
  double square = 0.0;
  for (Eigen::Index e = 0; e < model.mesh.tets.rows(); ++e) {
    const auto nodes = model.mesh.tets.row(e);
    const bool there = std::any_of(nodes.begin(), nodes.end(), [&](int node) {
      return at_surface[static_cast<std::size_t>(node)];
    });
    if (!there) continue;
    square =
        std::max(square, lame_parameters(model.material, e).mu / density_of(model.material, e));
  }
  return std::sqrt(square);
}

double hertz(double angular_frequency) {
  return angular_frequency / (2.0 * std::numbers::pi);
}

// What is asked for, found by trying with more and more modes where it is not their number. One
// more than is kept is computed: it says where the modes end.
class Choice {
 public:
  Choice(const ElasticStatics& statics, const Model& model, const FingertipReference& reference,
         double residual_radius, const LowestModes& solver, const Console& console)
      : statics_(statics),
        model_(model),
        reference_(reference),
        residual_radius_(residual_radius),
        solver_(solver),
        console_(console),
        most_(most_lowest_modes(statics) - 1) {}

  ModalResponse of(const ModesConfig& config) const {
    if (config.count) return by_count(*config.count);
    if (config.highest_frequency) return by_frequency(*config.highest_frequency);
    return by_error(*config.error, config.most);
  }

 private:
  ModalResponse by_count(int count) const {
    if (count > most_) too_many(std::to_string(count));
    return smoothly_cut(lowest(count), count);
  }

  ModalResponse by_frequency(double highest) const {
    for (int count = std::min(kFirstTry, most_);;) {
      const ModalResponse modes = lowest(count);
      const double last = hertz(modes.angular_frequency(count));
      if (last > highest) return smoothly_cut(modes, count_up_to(modes, highest));
      if (count == most_) too_many("more than " + std::to_string(most_));
      // Their number grows with the third power of the frequency.
      const double guess = 1.1 * count * std::pow(highest / last, 3) + 16.0;
      count = static_cast<int>(std::min<double>(most_, std::min(guess, 8.0 * count)));
    }
  }

  ModalResponse by_error(double error, std::optional<int> bound) const {
    const int most = std::min(bound.value_or(most_), most_);
    int below = 0;  // so many are too few
    for (int count = std::min(kFirstTry, most);; count = std::min(2 * count, most)) {
      const ModalResponse modes = lowest(count);
      const auto good = [&](int tried) {
        return dies_away(modes.angular_frequency(tried)) &&
               reference_.expected_force_error(smoothly_cut(modes, tried)) <= error;
      };
      if (good(count)) {
        int enough = count;
        while (enough - below > 1) {
          const int middle = (below + enough) / 2;
          (good(middle) ? enough : below) = middle;
        }
        return smoothly_cut(modes, enough);
      }
      if (count == most && bound) return smoothly_cut(modes, most);
      if (count == most) too_many("more than " + std::to_string(most));
      below = count;
    }
  }

  // What modes from here on add reaches about half a shear wave far.
  bool dies_away(double cut_off) const {
    return std::numbers::pi * surface_shear_speed(model_) / cut_off <= residual_radius_;
  }

  // And one more.
  ModalResponse lowest(int count) const {
    console_.line("modes: the lowest " + std::to_string(count) + " of " +
                  std::to_string(statics_.elastic_modes()) + " by Lanczos");
    const ElasticModes modes = solver_ ? solver_(count + 1) : lowest_modes(statics_, count + 1);
    ModalResponse response = modal_response(modes, model_.mesh.surface_nodes, model_.material);
    add_body_loads(modes, model_, response);
    return response;
  }

  int count_up_to(const ModalResponse& modes, double highest) const {
    const Eigen::VectorXd& omega = modes.angular_frequency;
    const auto count = std::count_if(omega.begin(), omega.end(),
                                     [highest](double w) { return hertz(w) <= highest; });
    if (count > 0) return static_cast<int>(count);
    throw Error("[modes]",
                "no mode is as low as " + std::to_string(highest) + " Hz; the lowest has " +
                    std::to_string(hertz(omega(0))) + " Hz",
                "raise highest_frequency");
  }

  [[noreturn]] void too_many(const std::string& wanted) const {
    throw Error("[modes]",
                wanted + " modes are asked for, of " + std::to_string(statics_.elastic_modes()) +
                    " that there are; at most half of them are computed one by one",
                "ask for fewer, or leave the table out for all of them");
  }

  const ElasticStatics& statics_;
  const Model& model_;
  const FingertipReference& reference_;
  double residual_radius_;
  const LowestModes& solver_;
  const Console& console_;
  int most_;
};

}  // namespace

ModalResponse compute_reduced_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                                    const Model& model, const ModesConfig& config, int threads,
                                    const Console& console, SharedSolvers shared) {
  const SingleThreadedBlas
      single;  // the factors' bits, and so the modes', do not depend on threads
  const bool any_thread_solves = shared.statics == nullptr;
  const ElasticStatics statics(
      assemble_stiffness(mesh, model.material), model.mesh.nodes, model.mesh.node_mass, clamped,
      any_thread_solves ? make_sparse_solver() : std::move(shared.statics));
  const FingertipReference reference(statics, model, config.contact_radius, clamped);
  const double radius = residual_radius(model.mesh, config.contact_radius);
  ModalResponse response =
      Choice(statics, model, reference, radius, shared.modes, console).of(config);
  ModeReduction reduction = response.residual.reduction;
  response.residual = residual_compliance(statics, model.mesh, response, radius,
                                          any_thread_solves ? threads : 1, console);
  add_gravity_rest(statics, model, response);
  const ReductionError error = reference.error(response);
  reduction.elastic_modes = static_cast<int>(statics.elastic_modes());
  reduction.contact_radius = config.contact_radius;
  reduction.residual_radius = response.residual.reduction.residual_radius;
  reduction.added_compliance = response.residual.reduction.added_compliance;
  reduction.press_time = press_time(model.dt);
  reduction.force_error = error.force;
  reduction.shape_error = error.shape;
  reduction.samples = reference.samples();
  response.residual.reduction = reduction;
  return response;
}

}  // namespace irdm::precompute
