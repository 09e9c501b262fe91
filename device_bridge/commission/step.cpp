#include "device_bridge/commission/step.hpp"

#include <array>
#include <sstream>

namespace irdm::commission {

StepRecord judged(const Step& step, Measured& measured) {
  const Judgement judgement = step.judge(measured);
  return {step.name(), judgement.passed ? Verdict::kPassed : Verdict::kFailed, judgement.words};
}

const char* direction_word(int axis) noexcept {
  constexpr std::array kWords{"right", "up", "towards you"};
  return kWords.at(static_cast<std::size_t>(axis));
}

std::string axis_word(const Vector3& way) {
  Eigen::Index axis = 0;
  way.cwiseAbs().maxCoeff(&axis);
  return std::string(way[axis] < 0.0 ? "-" : "+") + "xyz"[axis];
}

bool along_an_axis(const Vector3& way) noexcept {
  Eigen::Index axis = 0;
  const Vector3 size = way.cwiseAbs();
  const double largest = size.maxCoeff(&axis);
  return 2.0 * size[(axis + 1) % 3] <= largest && 2.0 * size[(axis + 2) % 3] <= largest;
}

std::string in_unit(double value, const char* unit) {
  std::ostringstream text;
  text.precision(4);
  text << value << ' ' << unit;
  return text.str();
}

}  // namespace irdm::commission
