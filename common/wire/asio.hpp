#pragma once

// Boost 1.74 uses std::exchange without including its header; under C++20 it must come first.
#include <utility>

#include <boost/asio.hpp>
