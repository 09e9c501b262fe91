#include "precompute/modal/reduced_modes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "common/error.hpp"
#include "precompute/fem/centrifugal_load.hpp"
#include "precompute/modal/fingertip_reference.hpp"
#include "precompute/modal/lowest_modes.hpp"
#include "precompute/modal/press.hpp"
#include "precompute/modal/residual_compliance.hpp"

namespace irdm::precompute {
namespace {

constexpr int kFirstTry = 64;

double hertz(double angular_frequency) {
  return angular_frequency / (2.0 * std::numbers::pi);
}

void keep_lowest(ElasticModes& modes, Eigen::Index count) {
  modes.angular_frequency.conservativeResize(count);
  modes.shapes.conservativeResize(Eigen::NoChange, count);
}

// What is asked for, found by trying with more and more modes where it is not their number.
class Choice {
 public:
  Choice(const ElasticStatics& statics, const Model& model, const FingertipReference& reference,
         const Console& console)
      : statics_(statics),
        model_(model),
        reference_(reference),
        console_(console),
        most_(most_lowest_modes(statics)) {}

  ElasticModes by_count(int count) const {
    if (count > most_) too_many(std::to_string(count));
    return lowest(count);
  }

  ElasticModes by_frequency(double highest) const {
    for (int count = std::min(kFirstTry, most_);;) {
      ElasticModes modes = lowest(count);
      const double last = hertz(modes.angular_frequency(count - 1));
      if (last > highest) {
        keep_up_to(modes, highest);
        return modes;
      }
      if (count == most_) too_many("more than " + std::to_string(most_));
      // Their number grows with the third power of the frequency.
      const double guess = 1.1 * count * std::pow(highest / last, 3) + 16.0;
      count = static_cast<int>(std::min<double>(most_, std::min(guess, 8.0 * count)));
    }
  }

  ElasticModes by_error(double error) const {
    for (int count = std::min(kFirstTry, most_);; count = std::min(2 * count, most_)) {
      ElasticModes modes = lowest(count);
      const auto errors = reference_.errors_by_count(at_surface(modes));
      const auto good = [error](const ReductionError& e) {
        return e.force <= error && e.shape <= error;
      };
      if (good(errors.back())) {
        const auto bad = std::find_if_not(errors.rbegin(), errors.rend(), good);
        const auto needed = errors.rend() - bad + 1;
        keep_lowest(modes, std::min<Eigen::Index>(needed, count));
        return modes;
      }
      if (count == most_) too_many("more than " + std::to_string(most_));
    }
  }

 private:
  ElasticModes lowest(int count) const {
    console_.line("modes: the lowest " + std::to_string(count) + " of " +
                  std::to_string(statics_.elastic_modes()) + " by Lanczos");
    return lowest_modes(statics_, count);
  }

  void keep_up_to(ElasticModes& modes, double highest) const {
    const Eigen::VectorXd& omega = modes.angular_frequency;
    const auto count = std::count_if(omega.begin(), omega.end(),
                                     [highest](double w) { return hertz(w) <= highest; });
    if (count == 0) {
      throw Error("[modes]",
                  "no mode is as low as " + std::to_string(highest) + " Hz; the lowest has " +
                      std::to_string(hertz(omega(0))) + " Hz",
                  "raise highest_frequency");
    }
    keep_lowest(modes, count);
  }

  ModalResponse at_surface(const ElasticModes& modes) const {
    return modal_response(modes, model_.mesh.surface_nodes, model_.material);
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
  const Console& console_;
  int most_;
};

ElasticModes choose(const Choice& choice, const ModesConfig& config) {
  if (config.count) return choice.by_count(*config.count);
  if (config.highest_frequency) return choice.by_frequency(*config.highest_frequency);
  return choice.by_error(*config.error);
}

}  // namespace

ModalResponse compute_reduced_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                                    const Model& model, const ModesConfig& config, int threads,
                                    const Console& console) {
  const ElasticStatics statics(assemble_stiffness(mesh, lame_parameters(model.material)),
                               model.mesh.nodes, model.mesh.node_mass, clamped);
  const double radius = residual_radius(model.mesh, config.contact_radius);
  const FingertipReference reference(statics, model, config.contact_radius, radius, clamped);
  const ElasticModes modes = choose(Choice(statics, model, reference, console), config);
  ModalResponse response = modal_response(modes, model.mesh.surface_nodes, model.material);
  if (model.body.support == Support::kFloating) {
    response.centrifugal =
        modes.shapes.transpose() * centrifugal_loads(model.mesh.nodes, model.mesh.node_mass);
  }
  response.residual = residual_compliance(statics, model.mesh, response, radius, threads, console);
  const ReductionError error = reference.error(response);
  ModeReduction& reduction = response.residual.reduction;
  reduction.elastic_modes = static_cast<int>(statics.elastic_modes());
  reduction.contact_radius = config.contact_radius;
  reduction.press_time = press_time(model.dt);
  reduction.force_error = error.force;
  reduction.shape_error = error.shape;
  reduction.samples = reference.samples();
  return response;
}

}  // namespace irdm::precompute
