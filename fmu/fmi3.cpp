// FMI 3.0 co-simulation with event mode and early return: names of the standard over an Instance.
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "entry.hpp"
#include "fmi.hpp"

namespace {

using pindrive_c::fail;
using pindrive_fmu::Instance;

struct Component {
  Instance instance;
  fmi3LogMessageCallback log;
  fmi3InstanceEnvironment environment;
  bool events, may_end_early;

  fmi3Status told(pindrive_error error) const {
    if (!error) return fmi3OK;
    if (log) log(environment, fmi3Error, "logStatusError", pindrive_last_error());
    return fmi3Error;
  }
};
Component& at(fmi3Instance c) { return *static_cast<Component*>(c); }

template <class Function>
fmi3Status attempt(fmi3Instance c, Function&& function) {
  return pindrive_fmu::attempt<Component>(c, function);
}
template <class Function>
fmi3Status each(fmi3Instance c, size_t count, Function&& function) {
  return pindrive_fmu::each<Component>(c, count, function);
}

fmi3Status unsupported(fmi3Instance c, const char* what) {
  return at(c).told(fail(PINDRIVE_UNSUPPORTED, "a drive has no %s", what));
}

}  // namespace

PINDRIVE_FMI const char* fmi3GetVersion(void) { return "3.0"; }
PINDRIVE_FMI fmi3Status fmi3SetDebugLogging(fmi3Instance, fmi3Boolean, size_t, const fmi3String[]) {
  return fmi3OK;
}

PINDRIVE_FMI fmi3Instance fmi3InstantiateModelExchange(fmi3String, fmi3String, fmi3String,
                                                       fmi3Boolean, fmi3Boolean,
                                                       fmi3InstanceEnvironment environment,
                                                       fmi3LogMessageCallback log) {
  if (log)
    log(environment, fmi3Error, "logStatusError",
        "a drive is for co-simulation: it solves its own equations");
  return nullptr;
}
PINDRIVE_FMI fmi3Instance fmi3InstantiateScheduledExecution(
    fmi3String, fmi3String, fmi3String, fmi3Boolean, fmi3Boolean,
    fmi3InstanceEnvironment environment, fmi3LogMessageCallback log, fmi3ClockUpdateCallback,
    fmi3LockPreemptionCallback, fmi3UnlockPreemptionCallback) {
  return fmi3InstantiateModelExchange(nullptr, nullptr, nullptr, false, false, environment, log);
}
PINDRIVE_FMI fmi3Instance
fmi3InstantiateCoSimulation(fmi3String, fmi3String token, fmi3String resources, fmi3Boolean,
                            fmi3Boolean, fmi3Boolean events, fmi3Boolean may_end_early,
                            const fmi3ValueReference[], size_t, fmi3InstanceEnvironment environment,
                            fmi3LogMessageCallback log, fmi3IntermediateUpdateCallback) {
  auto made = std::make_unique<Component>();
  made->log = log;
  made->environment = environment;
  made->events = events;
  made->may_end_early = may_end_early;
  const pindrive_error error = made->instance.begin(resources ? resources : "", token ? token : "");
  return made->told(error) == fmi3OK ? made.release() : nullptr;
}
PINDRIVE_FMI void fmi3FreeInstance(fmi3Instance c) { delete static_cast<Component*>(c); }

PINDRIVE_FMI fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean, fmi3Float64,
                                                    fmi3Float64 start, fmi3Boolean, fmi3Float64) {
  return attempt(c, [&](Instance& i) { return i.set_start_time(start); });
}
PINDRIVE_FMI fmi3Status fmi3ExitInitializationMode(fmi3Instance c) {
  return attempt(c, [](Instance& i) { return i.initialise(); });
}
PINDRIVE_FMI fmi3Status fmi3EnterEventMode(fmi3Instance) { return fmi3OK; }
PINDRIVE_FMI fmi3Status fmi3EnterStepMode(fmi3Instance) { return fmi3OK; }
PINDRIVE_FMI fmi3Status fmi3Terminate(fmi3Instance) { return fmi3OK; }
PINDRIVE_FMI fmi3Status fmi3Reset(fmi3Instance c) {
  at(c).instance.reset();
  return fmi3OK;
}
PINDRIVE_FMI fmi3Status fmi3EnterConfigurationMode(fmi3Instance) { return fmi3OK; }
PINDRIVE_FMI fmi3Status fmi3ExitConfigurationMode(fmi3Instance) { return fmi3OK; }

PINDRIVE_FMI fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                       fmi3Float64 value[], size_t) {
  return each(c, n, [&](Instance& i, size_t k) { return i.number(vr[k], value[k]); });
}
PINDRIVE_FMI fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                       const fmi3Float64 value[], size_t) {
  return each(c, n, [&](Instance& i, size_t k) { return i.set(vr[k], value[k]); });
}
PINDRIVE_FMI fmi3Status fmi3GetInt32(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                     fmi3Int32 value[], size_t) {
  return each(c, n, [&](Instance& i, size_t k) { return i.whole(vr[k], value[k]); });
}
PINDRIVE_FMI fmi3Status fmi3GetBoolean(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                       fmi3Boolean value[], size_t) {
  return each(c, n, [&](Instance& i, size_t k) { return i.flag(vr[k], value[k]); });
}
PINDRIVE_FMI fmi3Status fmi3SetBoolean(fmi3Instance c, const fmi3ValueReference vr[], size_t n,
                                       const fmi3Boolean value[], size_t) {
  return each(c, n, [&](Instance& i, size_t k) { return i.set_flag(vr[k], value[k]); });
}

#define PINDRIVE_NO_VARIABLES(type)                                                           \
  PINDRIVE_FMI fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference[], size_t n, \
                                        fmi3##type[], size_t) {                               \
    return n == 0 ? fmi3OK : unsupported(c, "variables of type " #type);                      \
  }                                                                                           \
  PINDRIVE_FMI fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference[], size_t n, \
                                        const fmi3##type[], size_t) {                         \
    return n == 0 ? fmi3OK : unsupported(c, "variables of type " #type " that can be set");   \
  }
PINDRIVE_NO_VARIABLES(Float32)
PINDRIVE_NO_VARIABLES(Int8)
PINDRIVE_NO_VARIABLES(UInt8)
PINDRIVE_NO_VARIABLES(Int16)
PINDRIVE_NO_VARIABLES(UInt16)
PINDRIVE_NO_VARIABLES(UInt32)
PINDRIVE_NO_VARIABLES(Int64)
PINDRIVE_NO_VARIABLES(UInt64)
PINDRIVE_NO_VARIABLES(String)
#undef PINDRIVE_NO_VARIABLES

PINDRIVE_FMI fmi3Status fmi3SetInt32(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                     const fmi3Int32[], size_t) {
  return n == 0 ? fmi3OK : unsupported(c, "variables of type Int32 that can be set");
}
PINDRIVE_FMI fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                      size_t[], fmi3Binary[], size_t) {
  return n == 0 ? fmi3OK : unsupported(c, "binary variables");
}
PINDRIVE_FMI fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                      const size_t[], const fmi3Binary[], size_t) {
  return n == 0 ? fmi3OK : unsupported(c, "binary variables");
}
PINDRIVE_FMI fmi3Status fmi3GetClock(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                     fmi3Clock[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3SetClock(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                     const fmi3Clock[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3GetNumberOfVariableDependencies(fmi3Instance c, fmi3ValueReference,
                                                            size_t*) {
  return unsupported(c, "dependencies that change");
}
PINDRIVE_FMI fmi3Status fmi3GetVariableDependencies(fmi3Instance c, fmi3ValueReference, size_t[],
                                                    fmi3ValueReference[], size_t[],
                                                    fmi3DependencyKind[], size_t) {
  return unsupported(c, "dependencies that change");
}

PINDRIVE_FMI fmi3Status fmi3GetFMUState(fmi3Instance c, fmi3FMUState* state) {
  return pindrive_fmu::keep_state<Component>(c, state);
}
PINDRIVE_FMI fmi3Status fmi3SetFMUState(fmi3Instance c, fmi3FMUState state) {
  return pindrive_fmu::restore_state<Component>(c, state);
}
PINDRIVE_FMI fmi3Status fmi3FreeFMUState(fmi3Instance, fmi3FMUState* state) {
  pindrive_fmu::free_state(state);
  return fmi3OK;
}
PINDRIVE_FMI fmi3Status fmi3SerializedFMUStateSize(fmi3Instance c, fmi3FMUState state,
                                                   size_t* size) {
  return pindrive_fmu::serialized_size<Component>(c, state, size);
}
PINDRIVE_FMI fmi3Status fmi3SerializeFMUState(fmi3Instance c, fmi3FMUState state, fmi3Byte bytes[],
                                              size_t size) {
  return pindrive_fmu::serialize<Component>(c, state, bytes, size);
}
PINDRIVE_FMI fmi3Status fmi3DeserializeFMUState(fmi3Instance c, const fmi3Byte bytes[], size_t size,
                                                fmi3FMUState* state) {
  return pindrive_fmu::deserialize<Component>(c, bytes, size, state);
}

PINDRIVE_FMI fmi3Status fmi3GetDirectionalDerivative(fmi3Instance c,
                                                     const fmi3ValueReference unknown[],
                                                     size_t unknowns,
                                                     const fmi3ValueReference known[],
                                                     size_t knowns, const fmi3Float64 seed[],
                                                     size_t, fmi3Float64 found[], size_t) {
  return each(c, unknowns, [&](Instance& i, size_t k) {
    return i.derivative(unknown[k], known, seed, knowns, found[k]);
  });
}
PINDRIVE_FMI fmi3Status fmi3GetAdjointDerivative(fmi3Instance c, const fmi3ValueReference[], size_t,
                                                 const fmi3ValueReference[], size_t,
                                                 const fmi3Float64[], size_t, fmi3Float64[],
                                                 size_t) {
  return unsupported(c, "adjoint derivatives");
}

PINDRIVE_FMI fmi3Status fmi3GetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                               fmi3Float64[], fmi3IntervalQualifier[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3GetIntervalFraction(fmi3Instance c, const fmi3ValueReference[],
                                                size_t n, fmi3UInt64[], fmi3UInt64[],
                                                fmi3IntervalQualifier[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3GetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                            fmi3Float64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3GetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                             fmi3UInt64[], fmi3UInt64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3SetIntervalDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                               const fmi3Float64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3SetIntervalFraction(fmi3Instance c, const fmi3ValueReference[],
                                                size_t n, const fmi3UInt64[], const fmi3UInt64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3SetShiftDecimal(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                            const fmi3Float64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3SetShiftFraction(fmi3Instance c, const fmi3ValueReference[], size_t n,
                                             const fmi3UInt64[], const fmi3UInt64[]) {
  return n == 0 ? fmi3OK : unsupported(c, "clocks");
}
PINDRIVE_FMI fmi3Status fmi3EvaluateDiscreteStates(fmi3Instance) { return fmi3OK; }
PINDRIVE_FMI fmi3Status fmi3UpdateDiscreteStates(fmi3Instance c, fmi3Boolean* needs_update,
                                                 fmi3Boolean* terminate, fmi3Boolean* nominals,
                                                 fmi3Boolean* states, fmi3Boolean* defined,
                                                 fmi3Float64* next) {
  return attempt(c, [&](Instance& i) {
    *needs_update = *terminate = *nominals = *states = false;
    double event = 0;
    const pindrive_error error = i.next_event(event);
    *defined = !error && std::isfinite(event);
    if (*defined) *next = event;
    return error;
  });
}

PINDRIVE_FMI fmi3Status fmi3GetOutputDerivatives(fmi3Instance c, const fmi3ValueReference[],
                                                 size_t n, const fmi3Int32[], fmi3Float64[],
                                                 size_t) {
  return n == 0 ? fmi3OK : unsupported(c, "derivatives of outputs");
}
PINDRIVE_FMI fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 from, fmi3Float64 size, fmi3Boolean,
                                   fmi3Boolean* event, fmi3Boolean* terminate, fmi3Boolean* early,
                                   fmi3Float64* last) {
  const Component& own = at(c);
  *event = *terminate = *early = false;
  return attempt(c, [&](Instance& i) {
    bool happens = false;
    pindrive_error error = i.step(from, size, own.events && own.may_end_early, happens);
    if (!error) error = i.now(*last);
    *event = own.events && happens;
    *early = !error && *last < from + size;
    return error;
  });
}

// An importer may look up the functions of model exchange too.
PINDRIVE_FMI fmi3Status fmi3EnterContinuousTimeMode(fmi3Instance c) {
  return unsupported(c, "continuous time");
}
PINDRIVE_FMI fmi3Status fmi3CompletedIntegratorStep(fmi3Instance c, fmi3Boolean, fmi3Boolean*,
                                                    fmi3Boolean*) {
  return unsupported(c, "continuous time");
}
PINDRIVE_FMI fmi3Status fmi3SetTime(fmi3Instance c, fmi3Float64) {
  return unsupported(c, "continuous time");
}
PINDRIVE_FMI fmi3Status fmi3SetContinuousStates(fmi3Instance c, const fmi3Float64[], size_t) {
  return unsupported(c, "continuous states");
}
PINDRIVE_FMI fmi3Status fmi3GetContinuousStateDerivatives(fmi3Instance c, fmi3Float64[], size_t) {
  return unsupported(c, "continuous states");
}
PINDRIVE_FMI fmi3Status fmi3GetEventIndicators(fmi3Instance c, fmi3Float64[], size_t) {
  return unsupported(c, "event indicators");
}
PINDRIVE_FMI fmi3Status fmi3GetContinuousStates(fmi3Instance c, fmi3Float64[], size_t) {
  return unsupported(c, "continuous states");
}
PINDRIVE_FMI fmi3Status fmi3GetNominalsOfContinuousStates(fmi3Instance c, fmi3Float64[], size_t) {
  return unsupported(c, "continuous states");
}
PINDRIVE_FMI fmi3Status fmi3GetNumberOfEventIndicators(fmi3Instance, size_t* count) {
  *count = 0;
  return fmi3OK;
}
PINDRIVE_FMI fmi3Status fmi3GetNumberOfContinuousStates(fmi3Instance, size_t* count) {
  *count = 0;
  return fmi3OK;
}
PINDRIVE_FMI fmi3Status fmi3ActivateModelPartition(fmi3Instance c, fmi3ValueReference,
                                                   fmi3Float64) {
  return unsupported(c, "model partitions");
}
