#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <vector>

namespace irdm::python {

/// Shape that an array must have: its length along each axis.
using Shape = std::vector<pybind11::ssize_t>;

/// The conversions of all arrays that the module takes, from an array or nested sequences. They
/// raise TypeError for what has no such numbers in it (complex, masked, text, objects) and
/// ValueError for another shape or a number that would be changed. Under the interpreter's lock.
/// @param name of the argument, for messages
/// @param shape one of the given ones
pybind11::array_t<double> numbers(const pybind11::handle& given, const char* name,
                                  const std::vector<Shape>& shapes);
/// Whole numbers from 0 to 2^32 - 1, of any type.
pybind11::array_t<std::uint32_t> bit_fields(const pybind11::handle& given, const char* name,
                                            const std::vector<Shape>& shapes);
/// Truth values, or numbers that are 0 or 1.
pybind11::array_t<bool> flags(const pybind11::handle& given, const char* name,
                              const std::vector<Shape>& shapes);

}  // namespace irdm::python
