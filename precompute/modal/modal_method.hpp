#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/model/model_writer.hpp"
#include "precompute/columns/column_source.hpp"
#include "precompute/config.hpp"
#include "precompute/mesh/tet_mesh.hpp"
#include "precompute/progress.hpp"

/// Method "modal": R from all elastic modes of the finite elements.
namespace irdm::precompute {

/// How long all modes will take on this machine, with what else it does now [s].
double all_modes_seconds(int unknowns);

/// Whether modes are left out by default: the configuration says nothing about them, they are all
/// that R is made of, and all of them would take over a minute.
/// @param unknowns degrees of freedom that are not clamped
bool takes_fewer_modes(const PrecomputeConfig& config, int unknowns);

/// The modes by default where takes_fewer_modes(): as few as keep the force under a fingertip
/// within 1 % of that of all, and not so many that finding them takes minutes.
ModesConfig fewer_modes();

/// One line that says so, why, and how long both would take.
std::string fewer_modes_text(int unknowns);

/// All modes of the model, at its surface, in double precision, and what loads on the whole body
/// do to them; says on the console how long it may take and takes. Throws Error.
/// @param clamped nodes of a fixed body
ModalResponse compute_modes(const TetMesh& mesh, const std::vector<int>& clamped,
                            const Model& model, const Console& console);

/// Dense R of these modes, computed in the precision of the file.
std::unique_ptr<ColumnSource> modal_columns(const ModalResponse& response, const Model& model,
                                            Precision precision);

/// Writes R in the forms that `config` asks for: the dense one column by column, never held as a
/// whole.
/// @param threads > 0
void write_modal_response(ModelFileWriter& writer, ModalResponse response, const Model& model,
                          const ResponseConfig& config, int threads, const Console& console);

}  // namespace irdm::precompute
