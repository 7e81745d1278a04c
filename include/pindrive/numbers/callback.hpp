/// Reference to a function that is called during a computation and may end it early.
#pragma once

#include <type_traits>

namespace pindrive {

/// Calls a function that may return false to request no further calls; true to continue.
template <class Function, class... Arguments>
bool goes_on(Function& function, Arguments&&... arguments) {
  if constexpr (std::is_void_v<std::invoke_result_t<Function&, Arguments&...>>) {
    function(arguments...);
    return true;
  } else {
    return function(arguments...);
  }
}

/// Reference to a callable object, which must outlive the reference. A call returns true to continue; an
/// empty reference, or an object that returns nothing, always continues.
///
/// The engine takes callbacks by this one type, so that it is compiled once for all callers.
template <class... Arguments>
class Callback {
 public:
  constexpr Callback() = default;
  template <class Function,
            class = std::enable_if_t<!std::is_same_v<std::decay_t<Function>, Callback>>>
  constexpr Callback(Function&& function) noexcept  // NOLINT: a callable is a callback
      : object_(&function), call_([](const void* object, Arguments... arguments) {
          using Object = std::remove_reference_t<Function>;
          return goes_on(*static_cast<Object*>(const_cast<void*>(object)), arguments...);
        }) {}

  bool operator()(Arguments... arguments) const {
    return call_ == nullptr || call_(object_, arguments...);
  }

 private:
  const void* object_{nullptr};
  bool (*call_)(const void*, Arguments...){nullptr};
};

/// Called now and then during a long computation. If it returns false, the computation ends early and its
/// result is meaningless.
using GoOn = Callback<>;

namespace detail {

/// Type of a parameter from which no template argument is deduced, so that a lambda converts to it.
template <class T>
struct SameType {
  using type = T;
};
template <class T>
using Given = typename SameType<T>::type;

}  // namespace detail
}  // namespace pindrive
