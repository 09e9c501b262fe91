#!/usr/bin/env bash
# alignment.sh TREE CXX EIGEN DEFINITION...: libraries and a program that embeds them, each built for this processor or
# for any, lay matrices out alike and free each other's. DEFINITION: of Eigen, as the libraries are compiled; those of
# the program are in the installed CMake targets. EIGEN: include folder.
set -euo pipefail
tree=$1 cxx=$2 eigen=$3
shift 3
library=("${@/#/-D}")
mapfile -t program < <(grep -rhoE 'EIGEN_[A-Z_]+(=[0-9]+)?' "$tree/lib/cmake/irdm" | sort -u | sed 's/^/-D/')
grep -qw avx /proc/cpuinfo || { echo "test left out: this processor has no AVX"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/both.hpp" <<'EOF'
#include "common/geometry.hpp"
struct Held {
  char before;
  Eigen::Vector4d four;
  Eigen::Matrix4d more;
  irdm::Quaternion turned;
};
EOF
cat >"$work/library.cpp" <<'EOF'
#include "both.hpp"
unsigned long held_size() { return sizeof(Held); }
unsigned long held_alignment() { return alignof(Held); }
irdm::Points points(int count) { return irdm::Points::Constant(count, 3, 0.5); }
Eigen::MatrixXd product(const Eigen::MatrixXd& a, Eigen::MatrixXd b) { return a * b; }
EOF
cat >"$work/program.cpp" <<'EOF'
#include <cstdio>
#include "both.hpp"
unsigned long held_size();
unsigned long held_alignment();
irdm::Points points(int count);
Eigen::MatrixXd product(const Eigen::MatrixXd& a, Eigen::MatrixXd b);
int main() {
  std::printf("size %lu and %zu, alignment %lu and %zu\n", held_size(), sizeof(Held), held_alignment(), alignof(Held));
  if (held_size() != sizeof(Held) || held_alignment() != alignof(Held)) return 1;
  for (int count = 1; count < 200; ++count) {
    irdm::Points made = points(count);      // allocated there
    made.conservativeResize(2 * count, 3);  // and here
    if (made.topRows(count).sum() != 1.5 * count) return 1;
    const Eigen::MatrixXd a = Eigen::MatrixXd::Constant(count, count, 2.0);
    if (product(a, a) != a * a) return 1;
  }
}
EOF
compile() { # NAME PROCESSOR FLAG...: to NAME.PROCESSOR.o
  local name=$1 processor=$2
  shift 2
  "$cxx" -std=c++20 -O1 -I"$tree/include/irdm" -isystem "$eigen" "$@" -c "$work/$name.cpp" -o "$work/$name.$processor.o"
}
compile library any "${library[@]}"
compile library this -march=native "${library[@]}"
compile program any "${program[@]}"
compile program this -march=native "${program[@]}"
for of_library in any this; do
  for of_program in any this; do
    echo "library for $of_library processor, program for $of_program"
    "$cxx" "$work/program.$of_program.o" "$work/library.$of_library.o" -o "$work/program"
    "$work/program"
  done
done
