#pragma once

#include <vector>

#include "common/hdf5/file.hpp"
#include "common/response/stored_response.hpp"
#include "precompute/check/check_model.hpp"
#include "precompute/check/reciprocity.hpp"
#include "precompute/check/report.hpp"

/// The lines of the table, each from what was measured; the limits stand in docs/check.md.
namespace irdm::precompute {

/// What the file says of its content; dense R is not part of it.
Line checksum_line(const hdf5::File& file);
Line chunk_checksum_line(const hdf5::File& file);
/// Modes are read only when they are finite, with positive frequencies and no negative decay rates;
/// here: whether they decay as the material says.
Line modes_line(const ModalResponse& response, const Material& material);
/// Of modes that are left out: whether what they add can give no energy, and the stated errors.
Line residual_line(const ModalResponse& response);
/// What each region is made of, and whether it has elements enough; none of a body of one material.
Report region_lines(const Model& model);
/// Whether the triangles are the outer faces of the elements; nothing where they are.
Report surface_lines(const Model& model);
/// How far the elements are from finer ones, and whether they lock; the mesh and material of the
/// file.
Line elements_line(const Model& model);
Line reciprocity_line(const Reciprocity& reciprocity);
/// Static compliance and momentum of some columns against finite elements assembled again.
Report static_lines(const Model& model, const StoredResponse& R);
/// The same where modes are left out: compliance alone, and at the nodes alone where what they do
/// is kept.
Line static_line_of_some_modes(const Model& model, const StoredResponse& R);
/// From what was found at every node: passivity, stable inverse, stiffness, coupling.
/// @param coupling that is going to be used [N/m]; 0: not said
Report node_lines(const std::vector<NodeFindings>& nodes, const HandLoop& loop, double coupling);
/// @param left share of the response that is left at the last step
/// @param cut whether rendering ends there
Line decay_line(double left, bool cut);
/// What the step costs in the force of a led node, at the surface's nearest and farthest nodes, and
/// from which stiffness on that is 10 %.
/// @param model with all its modes
Line step_line(const Model& model);
/// Interval at which a wave is watched where R can be had at any time [s]: at most dt.
double wave_interval(const Model& model);
/// @param columns sampled every `dt` [s], `steps` of them at most
Line wave_line(const Model& model, const StoredResponse& R, double dt, int steps);

}  // namespace irdm::precompute
