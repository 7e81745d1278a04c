// What the headers of the C++ library need of its runtime. The unit carries no more of that: it would be as large
// again as all else, and no exception may pass through an importer. Without memory, the process ends.
#include <cstdlib>
#include <new>
#include <vector>

namespace {

void* memory(std::size_t size) noexcept { return std::malloc(size > 0 ? size : 1); }

}  // namespace

void* operator new(std::size_t size) {
  if (void* const found = memory(size)) return found;
  std::abort();
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return memory(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, const std::nothrow_t& /*tag*/) noexcept { std::free(memory); }

extern "C" void __cxa_pure_virtual() { std::abort(); }  // NOLINT(bugprone-reserved-identifier)

// NOLINTBEGIN(bugprone-*,cert-*): names of the libraries, which they declare so
namespace std {
#if defined(__GLIBCXX__) || defined(_LIBCPP_VERSION)
const nothrow_t nothrow{};
#endif
#if defined(__GLIBCXX__)
void __throw_length_error(const char* /*what*/) { abort(); }
void __throw_bad_alloc() { abort(); }
void __throw_bad_array_new_length() { abort(); }
#endif
}  // namespace std
#if defined(_LIBCPP_VERSION)
_LIBCPP_BEGIN_NAMESPACE_STD
[[noreturn]] void __libcpp_verbose_abort(const char* /*format*/, ...) noexcept { abort(); }
_LIBCPP_END_NAMESPACE_STD
#endif
// NOLINTEND(bugprone-*,cert-*)
