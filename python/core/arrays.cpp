#include "python/core/arrays.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace py = pybind11;

namespace irdm::python {
namespace {

using Contiguous = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string text_of(const Shape& shape) {
  std::string text = "(";
  for (std::size_t i = 0; i < shape.size(); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  }
  return text + (shape.size() == 1 ? ",)" : ")");
}

bool is_masked(const py::handle& given) {
  // Most arrays are none of a class of their own.
  const py::object plain = py::module_::import("numpy").attr("ndarray");
  if (py::type::handle_of(given).is(plain)) return false;
  return py::isinstance(given, py::module_::import("numpy.ma").attr("MaskedArray"));
}

// An array of real numbers or truth values, of one of the shapes.
Contiguous checked(const py::handle& given, const std::string& name,
                   const std::vector<Shape>& shapes) {
  if (is_masked(given)) {
    throw py::type_error(name + " is a masked array, and a mask means nothing here: fill it");
  }
  const py::array array = py::array::ensure(given);
  if (!array) throw py::type_error(name + " is not an array of numbers");
  if (std::string_view("biuf").find(array.dtype().kind()) == std::string_view::npos) {
    throw py::type_error(name + " has the type " + py::str(array.dtype()).cast<std::string>() +
                         ": give real numbers");
  }
  const Shape shape(array.shape(), array.shape() + array.ndim());
  if (std::find(shapes.begin(), shapes.end(), shape) == shapes.end()) {
    throw py::value_error(name + " has the shape " + text_of(shape) + ": give " +
                          text_of(shapes.front()));
  }
  return Contiguous::ensure(array);
}

// Their numbers in another type, where they are what `holds` says.
template <typename Number, typename Holds>
py::array_t<Number> converted(const Contiguous& from, const std::string& name, const Holds& holds,
                              const char* allowed) {
  py::array_t<Number> to(Shape(from.shape(), from.shape() + from.ndim()));
  Number* out = to.mutable_data();
  for (const double* in = from.data(); in != from.data() + from.size(); ++in) {
    if (!holds(*in)) {
      throw py::value_error(name + " has " + py::str(py::float_(*in)).cast<std::string>() +
                            ": give " + allowed);
    }
    *out++ = static_cast<Number>(*in);
  }
  return to;
}

}  // namespace

py::array_t<double> numbers(const py::handle& given, const char* name,
                            const std::vector<Shape>& shapes) {
  return checked(given, name, shapes);
}

py::array_t<std::uint32_t> bit_fields(const py::handle& given, const char* name,
                                      const std::vector<Shape>& shapes) {
  return converted<std::uint32_t>(
      checked(given, name, shapes), name,
      [](double x) { return x >= 0.0 && x < 4294967296.0 && x == std::floor(x); },
      "whole numbers from 0 to 4294967295");
}

py::array_t<bool> flags(const py::handle& given, const char* name,
                        const std::vector<Shape>& shapes) {
  return converted<bool>(
      checked(given, name, shapes), name, [](double x) { return x == 0.0 || x == 1.0; },
      "truth values");
}

}  // namespace irdm::python
