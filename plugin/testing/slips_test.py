"""That a slip chosen at run time does what the slip does when it is written: slips_test.py COMPILER SCRATCH_FOLDER

Every slip of a function is written into a copy of it, and one that can be chosen into another copy; both print the same.
"""

import concurrent.futures
import os
import pathlib
import subprocess
import sys

from slips import enumerations, slips_by_line

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLE = """  double sum = 7 - scale * n / 3.0;
  sum += v.x - v.y * v.z + 1;
  sum -= n * scale - 2;
  if (n < 3 || (scale > 1.5 && v.x <= v.y)) sum = -sum;
  const bool other = n >= 4 && !(v.z > sum) || v.y == scale;
  if (other != (n == 2)) {
    sum = std::max(sum, v.x) + std::min({sum, v.y, v.z});
  }
  sum = std::clamp(sum, -9.0, 6.0);
  for (int i = 0; i < n && i <= 3; ++i) {
    sum = sum / 1.5 + (i > 1 ? v.z : -v.x);
  }
  for (int i = 0; i < n; ++i) sum += mixed(sum, scale) + std::floor(scale);
  sum = n > 4 ? sum - scale : sum + v.y;
  const Kind kind = n > 2 ? Kind::third : Kind::first;
  if (kind == Kind::first) sum += 3;
  const int most = 3;
  sum = sum * most + n;
  bool odd = false;
  odd = true;
  return other && odd ? sum : 2 * sum - (n % 2 == 0 ? 0.25 : scale);
"""
HEAD = """#include <cmath>
#include <cstdio>
#include <cstdlib>
struct Vector {
  double x = 0, y = 0, z = 0;
  double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};
enum class Kind { first, second, third };
double mixed(double a, double b) { return 2 * a - b; }
using Function = double (*)(const Vector&, int, double);
"""
MAIN = """int main(int, char** arguments) {
  for (int n = 0; n < 6; ++n) {
    for (double scale : {0.5, 1.5, 2.0}) std::printf("%.17g ", all[std::atoi(arguments[1])]({0.5 * n, 2, 1.5}, n, scale));
  }
}
"""


# Written as the tool sees a function: with its head, of which nothing is changed.
HEADED = "double f(const Vector& v, int n, double scale) {\n" + EXAMPLE


def with_line(number, line):
    lines = EXAMPLE.split("\n")
    return "\n".join([*lines[: number - 1], line, *lines[number:]])


def main():
    compiler, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    enums = enumerations(HEAD)
    slips = [(number - 1, *slip) for number, found in slips_by_line(HEADED, range(2, 99), enums) for slip in found
             if not slip[1].strip() == "return;"]  # the function returns a value
    bodies = [EXAMPLE]
    for n, (number, _, written, chosen) in enumerate(slips):
        bodies += [with_line(number, written), with_line(number, chosen.replace("{@}", f"{{{n}}}").replace("on(@)", f"on({n})"))]
    functions = [f"double f{n}(const Vector& v, int n, double scale) {{\n{body}}}\n" for n, body in enumerate(bodies)]
    names = ", ".join(f"f{n}" for n in range(len(bodies)))
    source, program = folder / "slips.cpp", folder / "slips"
    source.write_text(HEAD + "".join(functions) + f"Function all[] = {{{names}}};\n" + MAIN)
    subprocess.run([compiler, "-std=c++20", "-w", "-include", HERE / "slip.h", source, "-o", program], check=True)

    def output_of(function, slip):
        try:
            return subprocess.run([program, str(function)], capture_output=True, text=True, timeout=1,
                                  env={**os.environ, "PALPATE_SLIP": str(slip)}).stdout
        except subprocess.TimeoutExpired:
            return "for ever"

    plain, acting, wrong = output_of(0, -1), set(), 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        told = pool.map(lambda n: (output_of(2 * n + 1, -1), output_of(2 * n + 2, n), output_of(2 * n + 2, -1)), range(len(slips)))
    for (_, name, written, chosen), (expected, found, not_chosen) in zip(slips, told):
        if found != expected or not_chosen != plain:
            wrong += 1
            print(f"{name}:\n  {written.strip()}\n  {chosen.strip()}\n{expected}\n{found}\n{not_chosen}")
        if expected != plain:
            acting.add(name)
    print(f"{len(slips)} slips, {wrong} wrong; {len(acting)} kinds change what is printed")
    sys.exit(wrong > 0 or len(acting) < 32)


if __name__ == "__main__":
    main()
