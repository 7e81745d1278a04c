// FMI 2.0 co-simulation: names of the standard over an Instance.
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "entry.hpp"
#include "fmi.hpp"

namespace {

using pindrive_c::fail;
using pindrive_fmu::Instance;

using Text = std::vector<char>;  // zero-terminated

struct Component {
  Instance instance;
  Text name;
  fmi2CallbackLogger log;
  fmi2ComponentEnvironment environment;

  fmi2Status told(pindrive_error error) const {
    if (!error) return fmi2OK;
    if (log)
      log(environment, name.data(), fmi2Error, "logStatusError", "%s", pindrive_last_error());
    return fmi2Error;
  }
};
Component& at(fmi2Component c) { return *static_cast<Component*>(c); }

template <class Function>
fmi2Status attempt(fmi2Component c, Function&& function) {
  return pindrive_fmu::attempt<Component>(c, function);
}
template <class Function>
fmi2Status each(fmi2Component c, size_t count, Function&& function) {
  return pindrive_fmu::each<Component>(c, count, function);
}

Text text(const char* from) { return Text(from, from + std::strlen(from) + 1); }

/// Value of a digit of a percent-encoding; −1 for any other character.
int digit(char c) {
  const char* const digits = "0123456789abcdef";
  const char small = static_cast<char>(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c);
  const char* const found = c != '\0' ? std::strchr(digits, small) : nullptr;
  return found ? static_cast<int>(found - digits) : -1;
}

/// The folder of a file URI.
Text folder_of(const char* uri) {
  const char* rest = uri ? uri : "";
  if (std::strncmp(rest, "file:", 5) == 0) {
    rest += 5;
    if (std::strncmp(rest, "//", 2) == 0) rest += 2 + std::strcspn(rest + 2, "/");
    if (rest[0] == '/' && rest[1] != '\0' && rest[2] == ':') ++rest;  // /C:/
  }
  Text path;
  for (; *rest; ++rest) {
    const int high = *rest == '%' ? digit(rest[1]) : -1, low = high < 0 ? -1 : digit(rest[2]);
    if (low >= 0) rest += 2;
    path.push_back(low < 0 ? *rest : static_cast<char>(16 * high + low));
  }
  path.push_back('\0');
  return path;
}

}  // namespace

PINDRIVE_FMI const char* fmi2GetTypesPlatform(void) { return "default"; }
PINDRIVE_FMI const char* fmi2GetVersion(void) { return "2.0"; }
PINDRIVE_FMI fmi2Status fmi2SetDebugLogging(fmi2Component, fmi2Boolean, size_t,
                                            const fmi2String[]) {
  return fmi2OK;
}

PINDRIVE_FMI fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid,
                                           fmi2String resources,
                                           const fmi2CallbackFunctions* functions, fmi2Boolean,
                                           fmi2Boolean) {
  auto made = std::make_unique<Component>();
  made->name = text(name ? name : "");
  made->log = functions ? functions->logger : nullptr;
  made->environment = functions ? functions->componentEnvironment : nullptr;
  const pindrive_error error =
      type == fmi2CoSimulation
          ? made->instance.begin(folder_of(resources).data(), guid ? guid : "")
          : fail(PINDRIVE_UNSUPPORTED, "a drive is for co-simulation: it solves its own equations");
  return made->told(error) == fmi2OK ? made.release() : nullptr;
}
PINDRIVE_FMI void fmi2FreeInstance(fmi2Component c) { delete static_cast<Component*>(c); }

PINDRIVE_FMI fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean, fmi2Real, fmi2Real start,
                                            fmi2Boolean, fmi2Real) {
  return attempt(c, [&](Instance& i) { return i.set_start_time(start); });
}
PINDRIVE_FMI fmi2Status fmi2EnterInitializationMode(fmi2Component) { return fmi2OK; }
PINDRIVE_FMI fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
  return attempt(c, [](Instance& i) { return i.initialise(); });
}
PINDRIVE_FMI fmi2Status fmi2Terminate(fmi2Component) { return fmi2OK; }
PINDRIVE_FMI fmi2Status fmi2Reset(fmi2Component c) {
  at(c).instance.reset();
  return fmi2OK;
}

PINDRIVE_FMI fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                    fmi2Real value[]) {
  return each(c, n, [&](Instance& i, size_t k) { return i.number(vr[k], value[k]); });
}
PINDRIVE_FMI fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       fmi2Integer value[]) {
  return each(c, n, [&](Instance& i, size_t k) { return i.whole(vr[k], value[k]); });
}
PINDRIVE_FMI fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                    const fmi2Real value[]) {
  return each(c, n, [&](Instance& i, size_t k) { return i.set(vr[k], value[k]); });
}
PINDRIVE_FMI fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       fmi2Boolean value[]) {
  return each(c, n, [&](Instance& i, size_t k) {
    bool flag = false;
    const pindrive_error error = i.flag(vr[k], flag);
    value[k] = flag ? fmi2True : fmi2False;
    return error;
  });
}
PINDRIVE_FMI fmi2Status fmi2GetString(fmi2Component, const fmi2ValueReference[], size_t n,
                                      fmi2String[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
PINDRIVE_FMI fmi2Status fmi2SetInteger(fmi2Component, const fmi2ValueReference[], size_t n,
                                       const fmi2Integer[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
PINDRIVE_FMI fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference vr[], size_t n,
                                       const fmi2Boolean value[]) {
  return each(c, n,
              [&](Instance& i, size_t k) { return i.set_flag(vr[k], value[k] != fmi2False); });
}
PINDRIVE_FMI fmi2Status fmi2SetString(fmi2Component, const fmi2ValueReference[], size_t n,
                                      const fmi2String[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}

PINDRIVE_FMI fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate* state) {
  return pindrive_fmu::keep_state<Component>(c, state);
}
PINDRIVE_FMI fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
  return pindrive_fmu::restore_state<Component>(c, state);
}
PINDRIVE_FMI fmi2Status fmi2FreeFMUstate(fmi2Component, fmi2FMUstate* state) {
  pindrive_fmu::free_state(state);
  return fmi2OK;
}
PINDRIVE_FMI fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state,
                                                   size_t* size) {
  return pindrive_fmu::serialized_size<Component>(c, state, size);
}
PINDRIVE_FMI fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[],
                                              size_t size) {
  return pindrive_fmu::serialize<Component>(c, state, bytes, size);
}
PINDRIVE_FMI fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[],
                                                size_t size, fmi2FMUstate* state) {
  return pindrive_fmu::deserialize<Component>(c, bytes, size, state);
}

PINDRIVE_FMI fmi2Status fmi2GetDirectionalDerivative(
    fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
    const fmi2ValueReference known[], size_t knowns, const fmi2Real seed[], fmi2Real found[]) {
  return each(c, unknowns, [&](Instance& i, size_t k) {
    return i.derivative(unknown[k], known, seed, knowns, found[k]);
  });
}

PINDRIVE_FMI fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[],
                                                    size_t n, const fmi2Integer order[],
                                                    const fmi2Real value[]) {
  return each(c, n, [&](Instance& i, size_t k) {
    if (order[k] == 1) return i.set_rate(vr[k], value[k]);
    return fail(PINDRIVE_BAD_VALUE, "an input has a first derivative, and none of order %d",
                order[k]);
  });
}
PINDRIVE_FMI fmi2Status fmi2GetRealOutputDerivatives(fmi2Component, const fmi2ValueReference[],
                                                     size_t n, const fmi2Integer[], fmi2Real[]) {
  return n == 0 ? fmi2OK : fmi2Error;
}
PINDRIVE_FMI fmi2Status fmi2DoStep(fmi2Component c, fmi2Real from, fmi2Real size, fmi2Boolean) {
  bool happens = false;
  return attempt(c, [&](Instance& i) { return i.step(from, size, false, happens); });
}
PINDRIVE_FMI fmi2Status fmi2CancelStep(fmi2Component) { return fmi2Error; }
PINDRIVE_FMI fmi2Status fmi2GetStatus(fmi2Component, const fmi2StatusKind, fmi2Status*) {
  return fmi2Discard;
}
PINDRIVE_FMI fmi2Status fmi2GetRealStatus(fmi2Component c, const fmi2StatusKind kind,
                                          fmi2Real* value) {
  if (kind != fmi2LastSuccessfulTime) return fmi2Discard;
  return attempt(c, [&](Instance& i) { return i.now(*value); });
}
PINDRIVE_FMI fmi2Status fmi2GetIntegerStatus(fmi2Component, const fmi2StatusKind, fmi2Integer*) {
  return fmi2Discard;
}
PINDRIVE_FMI fmi2Status fmi2GetBooleanStatus(fmi2Component, const fmi2StatusKind kind,
                                             fmi2Boolean* value) {
  if (kind != fmi2Terminated) return fmi2Discard;
  *value = fmi2False;
  return fmi2OK;
}
PINDRIVE_FMI fmi2Status fmi2GetStringStatus(fmi2Component, const fmi2StatusKind, fmi2String*) {
  return fmi2Discard;
}
