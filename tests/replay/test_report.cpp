// Axes and curves of figures, where they can be told; and that a report needs nothing but itself.
#include <catch2/catch.hpp>
#include <limits>

#include "replay/report/axis.hpp"
#include "replay/report/comparison_html.hpp"
#include "replay/report/svg_chart.hpp"

using Catch::Matchers::Contains;
using namespace irdm;
using namespace irdm::replay;

TEST_CASE("ticks are round, within the axis, and as many as can be read") {
  CHECK(Axis{0.0, 1.0}.ticks() == std::vector<double>{0.0, 0.2, 0.4, 3 * 0.2, 0.8, 1.0});
  CHECK(Axis{-0.3, 0.31}.ticks().size() == 7);
  CHECK(replay::number_text(Axis{-0.3, 0.31}.ticks()[3]) == "0");
  CHECK(Axis{1.0, 100.0, true}.ticks() == std::vector<double>{1, 2, 5, 10, 20, 50, 100});
  const std::vector<double> decades = Axis{2e-4, 3.0, true}.ticks();
  REQUIRE(decades.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(decades[i] == Approx(std::pow(10.0, i - 3.0)));
  for (const double range : {3e-9, 0.07, 1.0, 42.0, 6e5}) {
    const std::size_t count = Axis{0.1 * range, 1.1 * range}.ticks().size();
    CHECK(count >= 4);
    CHECK(count <= 11);
  }
}

TEST_CASE("an axis has room for its values") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Axis linear = axis_for({3.0, nan, 8.0}, false);
  CHECK(linear.low == 0.0);
  CHECK(linear.place(8.0) < 1.0);
  CHECK(linear.place(8.0) > 0.9);
  const Axis mixed = axis_for({-2.0, 2.0}, false);
  CHECK(mixed.place(0.0) == Approx(0.5));
  const Axis logarithmic = axis_for({0.0, 1e-30, 10.0, 1000.0}, true, 4.0);
  CHECK(logarithmic.low == Approx(0.1 / 1.2));
  CHECK(Axis{1.0, 100.0, true}.place(10.0) == Approx(0.5));
  for (const bool log : {false, true}) {  // nothing, or nothing but one value
    CHECK(axis_for({}, log).high > axis_for({}, log).low);
    CHECK(axis_for({5.0, 5.0}, log).high > axis_for({5.0, 5.0}, log).low);
    CHECK(axis_for({0.0}, log).high > axis_for({0.0}, log).low);
  }
}

TEST_CASE("a curve goes through its points, and one of many through its peaks") {
  Chart chart{"time (s)", "force <N>", false, false, {}};
  chart.curves = {{"A & B", Stroke::kA, {0.0, 1.0, 2.0}, {0.0, 10.0, 5.0}}};
  const std::string svg = svg_of(chart);
  // From 78 to 704 across; from 248 at 0 up to 34 at 10 and 5 % to spare.
  CHECK_THAT(svg, Contains("points=\"78.0,248.0 391.0,44.2 704.0,146.1 \""));
  CHECK_THAT(svg, Contains("A &amp; B") && Contains("force &lt;N&gt;") && Contains("time (s)"));

  Curve& many = chart.curves[0];
  many = {"peak", Stroke::kA, {}, {}};
  for (int k = 0; k < 50'000; ++k) {
    many.x.push_back(k);
    many.y.push_back(k == 31'234 ? 10.0 : 1.0);
  }
  const std::string drawn = svg_of(chart);
  CHECK_THAT(drawn, Contains(",44.2 "));
  CHECK(drawn.size() < 40'000);
}

TEST_CASE("a report of runs that hardly are is made all the same") {
  Comparison comparison;
  comparison.a = "a<1>.h5";
  comparison.b = "b.h5";
  comparison.times = {0.1};
  comparison.frames = {{0, 0}};
  comparison.objects.resize(1);
  comparison.objects[0].name = "cube";
  for (Apart* apart : {&comparison.objects[0].centre_of_mass, &comparison.objects[0].orientation}) {
    apart->rms = apart->largest = {0.0};
  }
  comparison.forces = {comparison.objects[0].orientation};
  Measures measures;
  measures.nodes.resize(1);
  measures.styluses.resize(1);
  measures.styluses[0].difference.share = {0.0};
  measures.styluses[0].force.size_a = measures.styluses[0].force.size_b = {0.0};
  const std::string html = comparison_html(comparison, measures);
  CHECK_THAT(html, Contains("a&lt;1&gt;.h5") && Contains("not evenly spaced") &&
                       Contains("the meshes differ") && Contains("not judged: no contact in both"));
  CHECK_THAT(html, !Contains("nan") && !Contains("inf\"") && !Contains("<script"));
}
