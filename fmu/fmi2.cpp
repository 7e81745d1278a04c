// FMI 2.0 co-simulation: names of the standard over an Instance.
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <utility>

#include "fmi2Functions.h"
#include "instance.hpp"

namespace {

using pindrive_fmu::Failure;
using pindrive_fmu::Instance;

struct Component {
  Instance instance;
  std::string name;
  fmi2CallbackLogger log;
  fmi2ComponentEnvironment environment;
};
Component& at(fmi2Component c) { return *static_cast<Component*>(c); }

/// Runs what may be refused; the importer is told why.
template <class Function>
fmi2Status attempt(fmi2Component c, Function&& function) {
  std::string why;
  try {
    function(at(c).instance);
    return fmi2OK;
  } catch (const std::exception& error) {
    why = error.what();
  }
  const Component& own = at(c);
  if (own.log)
    own.log(own.environment, own.name.c_str(), fmi2Error, "logStatusError", "%s", why.c_str());
  return fmi2Error;
}

/// The folder of a file URI.
std::string folder_of(const char* uri) {
  std::string rest = uri ? uri : "";
  if (rest.compare(0, 5, "file:") == 0) {
    rest = rest.substr(5);
    if (rest.compare(0, 2, "//") == 0) {
      const std::size_t path = rest.find('/', 2);
      rest = path == std::string::npos ? "" : rest.substr(path);
    }
    if (rest.size() > 2 && rest[0] == '/' && rest[2] == ':') rest = rest.substr(1);  // /C:/
  }
  std::string path;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    if (rest[i] == '%' && i + 2 < rest.size()) {
      path += static_cast<char>(std::stoi(rest.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      path += rest[i];
    }
  }
  return path;
}

}  // namespace

extern "C" {

const char* fmi2GetTypesPlatform(void) { return fmi2TypesPlatform; }
const char* fmi2GetVersion(void) { return fmi2Version; }
fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, size_t, const fmi2String[]) {
  return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String resources,
                              const fmi2CallbackFunctions* functions, fmi2Boolean, fmi2Boolean) {
  std::string why = "a drive is for co-simulation: it solves its own equations";
  if (type == fmi2CoSimulation) try {
      auto made = std::make_unique<Component>(
          Component{Instance(folder_of(resources), guid ? guid : ""), name ? name : "",
                    functions ? functions->logger : nullptr,
                    functions ? functions->componentEnvironment : nullptr});
      return made.release();
    } catch (const std::exception& error) {
      why = error.what();
    }
  if (functions && functions->logger)
    functions->logger(functions->componentEnvironment, name, fmi2Error, "logStatusError", "%s",
                      why.c_str());
  return nullptr;
}
void fmi2FreeInstance(fmi2Component c) { delete static_cast<Component*>(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean, fmi2Real, fmi2Real start, fmi2Boolean,
                               fmi2Real) {
  return attempt(c, [&](Instance& i) { i.set_start_time(start); });
}
fmi2Status fmi2EnterInitializationMode(fmi2Component) { return fmi2OK; }
fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return attempt(c, [](Instance& i) { i.initialise(); });
}
fmi2Status fmi2Terminate(fmi2Component) { return fmi2OK; }
fmi2Status fmi2Reset(fmi2Component c) {
  return attempt(c, [](Instance& i) { i.reset(); });
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n, fmi2Real value[]) {
  return attempt(c, [&](Instance& i) {
    for (size_t k = 0; k < n; ++k) value[k] = i.number(vr[k]);
  });
}
fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                          fmi2Integer value[]) {
  return attempt(c, [&](Instance& i) {
    for (size_t k = 0; k < n; ++k) value[k] = i.whole(vr[k]);
  });
}
fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                       const fmi2Real value[]) {
  return attempt(c, [&](Instance& i) {
    for (size_t k = 0; k < n; ++k) i.set(vr[k], value[k]);
  });
}
fmi2Status fmi2GetBoolean(fmi2Component, const fmi2ValueReference[], size_t n, fmi2Boolean[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2GetString(fmi2Component, const fmi2ValueReference[], size_t n, fmi2String[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2SetInteger(fmi2Component, const fmi2ValueReference[], size_t n,
                          const fmi2Integer[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2SetBoolean(fmi2Component, const fmi2ValueReference[], size_t n,
                          const fmi2Boolean[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2SetString(fmi2Component, const fmi2ValueReference[], size_t n, const fmi2String[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return attempt(c, [&](Instance& i) {
    delete static_cast<Instance::State*>(std::exchange(*state, i.keep()));
  });
}
fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return attempt(c, [&](Instance& i) { i.go_back(*static_cast<Instance::State*>(state)); });
}
fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  delete static_cast<Instance::State*>(*state);
  *state = nullptr;
  return fmi2OK;
}
fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t* size) {
  return attempt(c, [&](Instance&) {
    *size = Instance::written(*static_cast<Instance::State*>(state)).size();
  });
}
fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                 size_t size) {
  return attempt(c, [&](Instance&) {
    const auto all = Instance::written(*static_cast<Instance::State*>(state));
    if (size != all.size()) throw Failure("the size must be that of the state");
    std::memcpy(bytes, all.data(), size);
  });
}
fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size,
                                   fmi2FMUstate* state) {
  return attempt(c, [&](Instance& i) {
    Instance::State* const found = i.read(reinterpret_cast<const unsigned char*>(bytes), size);
    delete static_cast<Instance::State*>(std::exchange(*state, found));
  });
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[],
                                        size_t unknowns, const fmi2ValueReference known[],
                                        size_t knowns, const fmi2Real seed[], fmi2Real found[]) {
  return attempt(c, [&](Instance& i) {
    for (size_t k = 0; k < unknowns; ++k) found[k] = i.derivative(unknown[k], known, seed, knowns);
  });
}

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Integer order[], const fmi2Real value[]) {
  return attempt(c, [&](Instance& i) {
    for (size_t k = 0; k < n; ++k) {
      if (order[k] != 1) throw Failure("an input has a first derivative, and no higher one");
      i.set_rate(vr[k], value[k]);
    }
  });
}
fmi2Status fmi2GetRealOutputDerivatives(fmi2Component, const fmi2ValueReference[], size_t n,
                                        const fmi2Integer[], fmi2Real[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real size, fmi2Boolean) {
  return attempt(c, [&](Instance& i) { i.step(from, size, false); });
}
fmi2Status fmi2CancelStep(fmi2Component) { return fmi2Error; }
fmi2Status fmi2GetStatus(fmi2Component, const fmi2StatusKind, fmi2Status*) { return fmi2Discard; }
fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind, fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  return attempt(c, [&](Instance& i) { *value = i.now(); });
}
fmi2Status fmi2GetIntegerStatus(fmi2Component, const fmi2StatusKind, fmi2Integer*) {
  return fmi2Discard;
}
fmi2Status fmi2GetBooleanStatus(fmi2Component, const fmi2StatusKind kind, fmi2Boolean* value) {
  if (kind != fmi2Terminated) return fmi2Discard;
  *value = fmi2False;
  return fmi2OK;
}
fmi2Status fmi2GetStringStatus(fmi2Component, const fmi2StatusKind, fmi2String*) {
  return fmi2Discard;
}

}  // extern "C"
