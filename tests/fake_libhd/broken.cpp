// A library that calls itself libHD.so and has next to nothing in it.
extern "C" unsigned hdInitDevice(const char*) {
  return 0;
}
