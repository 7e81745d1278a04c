// The memory in which the results of a batch go out to Python.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <memory>
#include <utility>

namespace pindrive_extension {

namespace nb = nanobind;

/// Rows of numbers, in memory that NumPy asks the system for in large pages. The system clears what it
/// hands out, which takes as long as a fifth of the work: the memory of results that nobody holds any
/// more therefore serves the next ones, if it is not large. Used with the interpreter's lock held.
class Rows {
 public:
  Rows(std::size_t count, std::size_t size) : size_(size) {
    PyObject* memory = std::exchange(kept, nullptr);
    if (!memory || length(memory) < count * size) {
      Py_XDECREF(memory);
      memory = nb::module_::import_("numpy").attr("empty")(count * size).release().ptr();
    }
    owner_ = nb::capsule(memory, [](void* given_back) noexcept {
      auto* memory = static_cast<PyObject*>(given_back);
      if (length(memory) <= most_kept && !(kept && length(kept) > length(memory)))
        std::swap(kept, memory);
      Py_XDECREF(memory);
    });
    values_ = nb::cast<Memory>(nb::handle(memory)).data();
  }
  double* operator[](std::size_t k) { return values_ + k * size_; }
  nb::ndarray<nb::numpy, double, nb::ndim<1>, nb::c_contig> array(std::size_t k) {
    return {(*this)[k], {size_}, owner_};
  }

 private:
  using Memory = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
  static std::size_t length(PyObject* memory) { return nb::len(nb::handle(memory)); }

  static constexpr std::size_t most_kept = std::size_t{1} << 23;  // numbers, 64 MiB
  inline static PyObject* kept = nullptr;
  std::size_t size_;
  nb::capsule owner_;
  double* values_{nullptr};
};

/// Column of flags or counts over all points, written once per point.
template <class T>
class Column {
 public:
  explicit Column(std::size_t size) : values_(new T[size]), size_(size) {}
  T& operator[](std::size_t i) { return values_[i]; }
  std::size_t size() const { return size_; }
  nb::ndarray<nb::numpy, T, nb::ndim<1>, nb::c_contig> array() {
    T* values = values_.release();
    const nb::capsule owner(values, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return {values, {size_}, owner};
  }

 private:
  std::unique_ptr<T[]> values_;
  std::size_t size_;
};

}  // namespace pindrive_extension
