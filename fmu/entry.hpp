/// Entry functions that FMI 2 and FMI 3 share, over an Instance.
///
/// `Component` is what an importer holds of a unit: it has the `instance`, and `told(error)` logs an error and
/// returns the status of its standard.
#pragma once

#include <cstring>
#include <memory>
#include <utility>
#include <vector>

#include "instance.hpp"
#include "interface.hpp"

namespace pindrive_fmu {

/// Runs a function that may fail; the importer is told why.
template <class Component, class Function>
auto attempt(void* component, Function&& function) {
  Component& of = *static_cast<Component*>(component);
  return of.told(function(of.instance));
}

/// Applies a function to several variables until one fails.
template <class Component, class Function>
auto each(void* component, std::size_t count, Function&& function) {
  return attempt<Component>(component, [&](Instance& instance) {
    pindrive_error error = PINDRIVE_OK;
    for (std::size_t k = 0; k < count && !error; ++k) error = function(instance, k);
    return error;
  });
}

/// Writes the state of an instance to `*state`, in place of the state there.
template <class Component>
auto keep_state(void* component, void** state) {
  return attempt<Component>(component, [&](Instance& instance) {
    std::unique_ptr<Instance::State> kept;
    const pindrive_error error = instance.keep(kept);
    if (!error) delete static_cast<Instance::State*>(std::exchange(*state, kept.release()));
    return error;
  });
}
template <class Component>
auto restore_state(void* component, void* state) {
  return attempt<Component>(component, [&](Instance& instance) {
    return instance.go_back(*static_cast<Instance::State*>(state));
  });
}
inline void free_state(void** state) {
  delete static_cast<Instance::State*>(std::exchange(*state, nullptr));
}

template <class Component>
auto serialized_size(void* component, void* state, std::size_t* size) {
  return attempt<Component>(component, [&](Instance&) {
    std::vector<unsigned char> all;
    const pindrive_error error = Instance::write(*static_cast<Instance::State*>(state), all);
    *size = all.size();
    return error;
  });
}
template <class Component>
auto serialize(void* component, void* state, void* bytes, std::size_t size) {
  return attempt<Component>(component, [&](Instance&) -> pindrive_error {
    std::vector<unsigned char> all;
    const pindrive_error error = Instance::write(*static_cast<Instance::State*>(state), all);
    if (error) return error;
    if (size != all.size())
      return pindrive_c::fail(PINDRIVE_BAD_VALUE,
                              "the size must be that of the state, %zu, not %zu", all.size(), size);
    std::memcpy(bytes, all.data(), size);
    return PINDRIVE_OK;
  });
}
template <class Component>
auto deserialize(void* component, const void* bytes, std::size_t size, void** state) {
  return attempt<Component>(component, [&](Instance& instance) {
    std::unique_ptr<Instance::State> found;
    const pindrive_error error =
        instance.read(static_cast<const unsigned char*>(bytes), size, found);
    if (!error) delete static_cast<Instance::State*>(std::exchange(*state, found.release()));
    return error;
  });
}

}  // namespace pindrive_fmu
