// Runtime functions that the headers of the C++ library need. The whole runtime would be as large
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

#if defined(__MINGW32__) && defined(__x86_64__) && defined(__clang__)
/// Stack probe of compilers for Windows: for a frame larger than a page, of the number of bytes in
/// rax, it touches each page in sequence, because Windows extends the stack by the next page alone.
/// All registers are preserved.
extern "C" __attribute__((naked)) void ___chkstk_ms() {  // NOLINT(bugprone-reserved-identifier)
  __asm__ volatile(
      "push %rcx\n"
      "push %rax\n"
      "lea 24(%rsp), %rcx\n"  // the frame begins below here
      "1: cmp $4096, %rax\n"
      "jb 2f\n"
      "sub $4096, %rcx\n"
      "test %rcx, (%rcx)\n"
      "sub $4096, %rax\n"
      "jmp 1b\n"
      "2: sub %rax, %rcx\n"
      "test %rcx, (%rcx)\n"
      "pop %rax\n"
      "pop %rcx\n"
      "ret\n");
}
#endif

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
