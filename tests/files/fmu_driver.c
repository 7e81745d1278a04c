/* Loads the library of an FMU by itself and follows a drive: driver LIBRARY RESOURCES TOKEN. Prints the outputs after
 * each step as Float64 has them, in C's hexadecimal notation. */
#include <stdio.h>
#include <string.h>

#include "fmi3Functions.h"
#ifdef _WIN32
#include <windows.h>
#define OPEN(path) LoadLibraryA(path)
#define FIND(library, name) GetProcAddress(library, name)
#else
#include <dlfcn.h>
#define OPEN(path) dlopen(path, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) dlsym(library, name)
#endif

static void log_message(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                        fmi3String message) {
  (void)environment, (void)status, (void)category;
  printf("%s\n", message);
}

#define NEED(call) \
  if ((call) != fmi3OK) return printf("failed: %s\n", #call), 1

int main(int count, char** given) {
  if (count < 4) return 2;
  void* library = (void*)OPEN(given[1]);
  if (!library) return puts("the library cannot be loaded"), 1;
#define GET(name) name##TYPE* const name##_ = (name##TYPE*)FIND(library, #name)
  GET(fmi3InstantiateCoSimulation);
  GET(fmi3EnterInitializationMode);
  GET(fmi3ExitInitializationMode);
  GET(fmi3SetFloat64);
  GET(fmi3GetFloat64);
  GET(fmi3DoStep);
  GET(fmi3FreeInstance);
  fmi3Instance unit =
      fmi3InstantiateCoSimulation_("pin", given[3], given[2], fmi3False, fmi3True, fmi3False,
                                   fmi3False, NULL, 0, NULL, log_message, NULL);
  if (!unit) return 1;
  fmi3ValueReference inputs[16], outputs[16];
  size_t in = 0, out = 0;
  for (int i = 4; i < count; ++i) { /* iN: an input; oN: an output */
    unsigned number = 0;
    sscanf(given[i] + 1, "%u", &number);
    if (given[i][0] == 'i')
      inputs[in++] = number;
    else
      outputs[out++] = number;
  }
  NEED(fmi3EnterInitializationMode_(unit, fmi3False, 0, 0, fmi3False, 0));
  NEED(fmi3ExitInitializationMode_(unit));
  double time = 0;
  for (int step = 0; step < 200; ++step) {
    double values[16] = {0}, last = 0;
    for (size_t k = 0; k < in; ++k) values[k] = 0.06 * ((7 * step + 3 * (int)k) % 11) / 11.0;
    NEED(fmi3SetFloat64_(unit, inputs, in, values, in));
    fmi3Boolean event, terminate, early;
    NEED(fmi3DoStep_(unit, time, 0.0017, fmi3True, &event, &terminate, &early, &last));
    time = last;
    NEED(fmi3GetFloat64_(unit, outputs, out, values, out));
    for (size_t k = 0; k < out; ++k) printf("%a ", values[k]);
    printf("\n");
  }
  NEED(fmi3SetFloat64_(unit, inputs, in, (double[16]){0}, in));
  if (fmi3DoStep_(unit, time + 1, 0.1, fmi3True, &(fmi3Boolean){0}, &(fmi3Boolean){0},
                  &(fmi3Boolean){0}, &time) != fmi3Error)
    return 1;
  fmi3FreeInstance_(unit);
  return 0;
}
