#include <cstdio>
#include <memory>
#include "bench/statistics.hpp"
#include "simulation/step/simulation.hpp"
#include "tests/support/fem_cube.hpp"
using namespace irdm;
#include <ctime>
template <class F>
double cpu(F f) {
  timespec a, b;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &a);
  f();
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &b);
  return b.tv_sec - a.tv_sec + 1e-9 * (b.tv_nsec - a.tv_nsec);
}
int main(int argc, char** argv) {
  int n = atoi(argv[1]);
  int modes = atoi(argv[2]);
  int steps = atoi(argv[3]);
  double E = argc > 4 ? atof(argv[4]) : 2000;
  int cells = argc > 5 ? atoi(argv[5]) : 12;
  SimulationConfig c;
  if (argc > 6) c.contact_samples = atoi(argv[6]);
  c.gravity = Vector3(0, -9.81, 0);
  c.objects.resize(n);
  for (int i = 0; i < n; ++i) {
    auto& o = c.objects[i];
    o.model = test::fem_cube({.cells = cells, .youngs_modulus = E, .modes = modes});
    o.position = Vector3(0, (2 * i + 1) * 0.06, 0);
    o.damping = {1, 1};
    o.friction = {0.5, 0.5};
  }
  c.scenery.resize(1);
  Simulation s(c);
  auto r = std::make_unique<StepRecord>();
  StylusCommand nobody;
  std::vector<double> t, sw;
  for (int k = 0; k < steps; ++k) {
    double x = cpu([&] { s.step({&nobody, 1}, *r); });
    if (k > steps / 4) {
      t.push_back(1e6 * x);
      sw.push_back(r->object[0].sweeps);
    }
    if (k % (steps / 10) == 0) {
      printf("%d n %d sw %d res %g solved %d", k, r->body_contact_count, r->object[0].sweeps,
             r->object[0].residual, r->object[0].solved);
      for (int i = 0; i < n; ++i)
        printf(" | %.5f %.5f %.5f", r->object[i].position.x(), r->object[i].position.y(),
               r->object[i].position.z());
      puts("");
    }
  }
  printf("median %.0f p99 %.0f us sweeps %.0f\n", bench::percentile(t, .5),
         bench::percentile(t, .99), bench::percentile(sw, .5));
}
