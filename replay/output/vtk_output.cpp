#include "replay/output/vtk_output.hpp"

#include <openssl/evp.h>
#include <bit>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "common/error.hpp"
#include "replay/output/output_file.hpp"

namespace irdm::replay {
namespace {

// The number of bytes and the bytes, in one piece.
std::string base64(std::span<const std::byte> bytes) {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  if (bytes.size() > kMost) throw std::length_error("too many numbers for one array of a VTK file");
  const std::uint64_t count = bytes.size();
  std::vector<unsigned char> all(sizeof count + bytes.size());
  std::memcpy(all.data(), &count, sizeof count);
  if (!bytes.empty()) std::memcpy(all.data() + sizeof count, bytes.data(), bytes.size());
  std::string text(4 * ((all.size() + 2) / 3) + 1, '\0');  // the last is for its final zero
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), all.data(),
                                     static_cast<int>(all.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

std::string array(const std::string& type, const std::string& name,
                  std::span<const std::byte> bytes, int components, const std::string& more) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\"" + more + ">" + base64(bytes) +
         "</DataArray>\n";
}

}  // namespace

std::string vtk_file(const std::string& type, const std::string& content) {
  const char* order = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + type + "\" version=\"1.0\" byte_order=\"" +
         order + "\" header_type=\"UInt64\">\n" + content + "</VTKFile>\n";
}

std::string vtk_array(const std::string& name, std::span<const double> values, int components,
                      const std::string& more) {
  return array("Float64", name, std::as_bytes(values), components, more);
}

std::string vtk_array(const std::string& name, std::span<const std::int32_t> values, int components,
                      const std::string& more) {
  return array("Int32", name, std::as_bytes(values), components, more);
}

namespace {

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string tag(const std::string& name, const std::string& content) {
  return "<" + name + ">\n" + content + "</" + name.substr(0, name.find(' ')) + ">\n";
}

std::span<const double> numbers(const Points& points) {
  return {points.data(), static_cast<std::size_t>(points.size())};
}

std::string cells(const std::string& kind, const std::vector<std::int32_t>& nodes, int corners) {
  std::vector<std::int32_t> ends(nodes.size() / static_cast<std::size_t>(corners));
  std::int32_t end = 0;
  for (std::int32_t& each : ends) each = end += corners;
  return tag(kind, vtk_array("connectivity", nodes, 1) + vtk_array("offsets", ends, 1));
}

std::string triangle_cells(const Triangles& triangles) {
  return cells("Polys", {triangles.data(), triangles.data() + triangles.size()}, 3);
}

std::string poly_data(double time, const Points& points, std::size_t vertices, std::size_t polygons,
                      const std::string& cell_text, const std::string& point_data) {
  const std::vector<double> times{time};
  const std::string piece = "Piece NumberOfPoints=\"" + std::to_string(points.rows()) +
                            "\" NumberOfVerts=\"" + std::to_string(vertices) +
                            "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                            std::to_string(polygons) + "\"";
  const std::string content =
      tag("FieldData", vtk_array("TimeValue", times, 1, " NumberOfTuples=\"1\"")) +
      tag(piece, point_data + tag("Points", vtk_array("Points", numbers(points), 3)) + cell_text);
  return vtk_file("PolyData", tag("PolyData", content));
}

}  // namespace

VtkOutput::VtkOutput(const std::filesystem::path& folder, const TracedScene& scene)
    : folder_(folder) {
  make_new_folder(folder_);
  const std::vector<std::string> names = plain_names(scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    Surface surface{names[i], scene.config.objects[i].model, nullptr, nullptr, ""};
    surface.rest = std::make_unique<RestSurface>(surface.model->mesh);
    surface.forces = std::make_unique<RecordedForces>(scene.config, i, *surface.rest);
    surface.triangles = triangle_cells(surface.model->mesh.triangles);
    surfaces_.push_back(std::move(surface));
  }
}

// Displacement: what the place of a node differs by from that of the rigid body.
std::string VtkOutput::surface_text(const Surface& surface, const ObjectRecord& object,
                                    const Points& displacement, const StepRecord& record) const {
  const ModelMesh& mesh = surface.model->mesh;
  const Eigen::Index count = mesh.surface_node_count();
  Points place(count, 3);
  Points moved(count, 3);
  Points force = Points::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vector3 u = displacement.row(i).transpose();
    place.row(i) =
        object.position + object.orientation * (mesh.rest_position(static_cast<int>(i)) + u);
    moved.row(i) = object.orientation * u;
  }
  for (const NodalForce& each : surface.forces->of(object, record.body_contacts())) {
    force.row(each.node) += (object.halfway * each.force).transpose();
  }
  return poly_data(
      record.time, place, 0, static_cast<std::size_t>(mesh.triangles.rows()), surface.triangles,
      tag("PointData Vectors=\"displacement\"",
          vtk_array("displacement", numbers(moved), 3) + vtk_array("force", numbers(force), 3)));
}

std::string VtkOutput::styluses_text(const StepRecord& record) const {
  const auto count = static_cast<std::size_t>(record.stylus_count);
  Points tip(count, 3);
  Points proxy(count, 3);
  Points force(count, 3);
  std::vector<std::int32_t> contact;
  std::vector<std::int32_t> present;
  for (std::size_t s = 0; s < count; ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    const StylusRecord& stylus = record.stylus[s];
    tip.row(row) = stylus.tip;
    proxy.row(row) = stylus.proxy;
    force.row(row) = stylus.force;
    contact.push_back(static_cast<std::int32_t>(stylus.contact));
    present.push_back(stylus.present ? 1 : 0);
  }
  std::vector<std::int32_t> points(count);
  std::iota(points.begin(), points.end(), 0);
  return poly_data(
      record.time, tip, count, 0, cells("Verts", points, 1),
      tag("PointData Vectors=\"force\"",
          vtk_array("force", numbers(force), 3) + vtk_array("proxy", numbers(proxy), 3) +
              vtk_array("contact", contact, 1) + vtk_array("present", present, 1)));
}

void VtkOutput::write(const std::string& name, const std::string& text) const {
  std::ofstream stream(folder_ / name, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) {
    throw Error((folder_ / name).string(), "cannot be written", "make room on the disk");
  }
}

void VtkOutput::write_part(const std::string& name, const std::string& text, double time,
                           std::size_t part) {
  char number[32];
  std::snprintf(number, sizeof number, "_%06zu.vtp", frames_);
  write(name + number, text);
  index_ += "<DataSet timestep=\"" + text_of(time) + "\" part=\"" + std::to_string(part) +
            "\" name=\"" + name + "\" file=\"" + name + number + "\"/>\n";
}

void VtkOutput::put(const ReplayFrame& frame) {
  const double time = frame.record.time;
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    write_part(
        surfaces_[i].name,
        surface_text(surfaces_[i], frame.record.object[i], frame.displacement[i], frame.record),
        time, i);
  }
  write_part("styluses", styluses_text(frame.record), time, surfaces_.size());
  ++frames_;
}

void VtkOutput::finish() {
  write("run.pvd", vtk_file("Collection", tag("Collection", index_)));
}

}  // namespace irdm::replay
