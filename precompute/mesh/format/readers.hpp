#pragma once

#include <filesystem>

#include "precompute/mesh/surface_mesh.hpp"
#include "precompute/mesh/tet_mesh.hpp"

/// One reader a format; each has a source of its own. mesh_file.hpp chooses.
namespace irdm::precompute {

/// Reads the tetrahedra of a Gmsh file, MSH 2.2 or 4.1, ASCII, all of first or all of second order
/// (mid-side nodes where the file has them); coordinates as they are there. Points, lines and
/// surface elements are passed over, but for the physical groups that they belong to, which become
/// the mesh's groups; those without a name go by their number. Nodes keep the order of the file.
/// Throws Error with file and line for other versions, binary files, other volume elements,
/// truncated or damaged files.
TetMesh read_gmsh(const std::filesystem::path& path);

/// Reads the tetrahedra of a Medit file (.mesh, ASCII); coordinates as they are there. Vertices,
/// edges, triangles and tetrahedra that carry the same reference, other than 0, become a group
/// whose name is the section's keyword in lower case and the reference: "triangles 3". Throws Error
/// with file and line for other volume elements, unknown sections, truncated or damaged files.
TetMesh read_medit(const std::filesystem::path& path);

/// Reads a mesh that TetGen wrote: a .node and an .ele file of the same name, either of which may
/// be given; numbered from 0 or from 1; coordinates as they are there. Attributes and markers are
/// passed over. Throws Error with file and line for missing, truncated or damaged files and for
/// second-order elements.
TetMesh read_tetgen(const std::filesystem::path& path);

/// Reads the linear tetrahedra of a VTK legacy file (versions 1.0 to 5.1, ASCII or binary) that
/// holds an unstructured grid; coordinates as they are there. Vertices, lines, surface cells and
/// all data on points and cells are passed over. Throws Error with file and line for other data
/// sets, other volume cells, truncated or damaged files.
TetMesh read_vtk(const std::filesystem::path& path);

/// Reads the linear tetrahedra of a VTK XML file (.vtu, one piece): arrays in the file or appended,
/// as text, base64 or raw bytes, plain or compressed by zlib, of either byte order, as ParaView,
/// VTK and meshio write them; coordinates as they are there. Vertices, lines, surface cells and all
/// data on points and cells are passed over. Throws Error for other compressors, several pieces,
/// other volume cells, truncated or damaged files.
TetMesh read_vtu(const std::filesystem::path& path);

/// Reads the vertices and faces of a Wavefront OBJ file, all its objects together; polygons are cut
/// into triangles; texture, normals, groups and materials are passed over. Throws Error with file
/// and line for truncated or damaged files.
SurfaceMesh read_obj(const std::filesystem::path& path);

/// Reads the vertices and faces of a PLY file, ASCII or binary of either byte order; polygons are
/// cut into triangles; other elements and properties are passed over. Throws Error with file and
/// line for truncated or damaged files.
SurfaceMesh read_ply(const std::filesystem::path& path);

/// Reads the triangles of an STL file, ASCII (all its solids) or binary; every triangle has three
/// nodes of its own, as in the file: see weld. Normals are passed over. Throws Error for truncated
/// or damaged files.
SurfaceMesh read_stl(const std::filesystem::path& path);

}  // namespace irdm::precompute
