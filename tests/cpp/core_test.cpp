// The tests of the core as one program: `core_test NAME [ARG...]`.
#include <cstdio>
#include <string>

// Each runs a test of its part and returns the exit status; -1 without a test of that name.
int core_test_0(const std::string& name, int argc, char** argv);
int core_test_1(const std::string& name, int argc, char** argv);

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "";
  for (const auto part : {core_test_0, core_test_1})
    if (const int status = part(name, argc - 1, argv + 1); status >= 0) return status;
  std::fprintf(stderr, "core_test: there is no test '%s'\n", name.c_str());
  return 2;
}
