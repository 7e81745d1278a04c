/// Arrays between Python and the core.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <utility>
#include <vector>

#include "interrupt.hpp"

/// Array of numbers from Python.
using Column =
    nanobind::ndarray<const double, nanobind::ndim<1>, nanobind::c_contig, nanobind::device::cpu>;
template <class T>
using Array = nanobind::ndarray<nanobind::numpy, T, nanobind::ndim<1>, nanobind::c_contig>;

/// Array that owns what a list held.
template <class T>
Array<T> to_array(std::vector<T>&& values) {
  auto* owned = new std::vector<T>(std::move(values));
  nanobind::capsule owner(owned, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  return Array<T>(owned->data(), {owned->size()}, owner);
}

/// Array of f(0), f(1), ..., f(count - 1), where f touches nothing of Python.
template <class N, class Function>
Array<N> mapped(std::size_t count, Function&& f) {
  return to_array(interruptible([&](auto go_on) {
    std::vector<N> found(count);
    for (std::size_t i = 0; i < count && go_on(); ++i) found[i] = static_cast<N>(f(i));
    return found;
  }));
}
