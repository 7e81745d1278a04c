#include "variables.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "interface.hpp"
#ifdef _WIN32
#include <windows.h>  // last: it defines near and far
#endif

namespace pindrive_fmu {

namespace {

using pindrive_c::fail;

constexpr const char* outputs[] = {
    "position",    "velocity",       "acceleration",  "plate_force",     "finger_force",
    "stretch",     "stretch_rate",   "housing_force", "next_event_time", "magnet_current",
    "magnet_pull", "magnet_warming", "plate_state",   "finger_state"};

/// Index of a name among the inputs, each followed by its rate, or among the outputs; −1 if
/// unknown.
int place_of(Variable::Kind kind, const char* name) {
  int place = 0;
  if (kind == Variable::input)
    for (const Input& input : inputs) {
      const std::size_t length = std::strlen(input.name);
      if (std::strcmp(name, input.name) == 0) return place;
      if (std::strncmp(name, input.name, length) == 0 &&
          std::strcmp(name + length, rate_ending) == 0)
        return place + 1;
      place += 2;
    }
  if (kind == Variable::output)
    for (const char* output : outputs) {
      if (std::strcmp(name, output) == 0) return place;
      ++place;
    }
  return -1;
}

std::FILE* opened(const char* path) {
#ifdef _WIN32
  const int size = MultiByteToWideChar(CP_UTF8, 0, path, -1, nullptr, 0);
  std::vector<wchar_t> wide(static_cast<std::size_t>(size) + 1);
  MultiByteToWideChar(CP_UTF8, 0, path, -1, wide.data(), size);
  return _wfopen(wide.data(), L"rb");
#else
  return std::fopen(path, "rb");
#endif
}

/// The bytes of a file, and a zero.
pindrive_error content_of(const char* path, std::vector<char>& content) {
  std::FILE* file = opened(path);
  if (!file) return fail(PINDRIVE_BAD_VALUE, "cannot read %.200s", path);
  content.clear();
  std::size_t size = 0;
  do {
    content.resize(size + 4096);
    size += std::fread(&content[size], 1, content.size() - size, file);
  } while (size == content.size() && !std::feof(file) && !std::ferror(file));
  std::fclose(file);
  content.resize(size);
  content.push_back('\0');
  return PINDRIVE_OK;
}

/// Cuts off the first word of a text; an empty word at its end.
char* next_word(char*& text) {
  constexpr const char* space = " \r\n";
  char* const word = text + std::strspn(text, space);
  text = word + std::strcspn(word, space);
  if (*text != '\0') *text++ = '\0';
  return word;
}

}  // namespace

pindrive_error read_variables(const char* path, const char* token, std::vector<char>& list,
                              std::vector<Variable>& variables) {
  if (const pindrive_error error = content_of(path, list)) return error;
  char* text = list.data();
  if (std::strcmp(next_word(text), "pindrive-fmu-2") != 0)
    return fail(PINDRIVE_BAD_VALUE, "the list of variables must be one of this version: %.200s",
                path);
  const char* const own = next_word(text);
  if (std::strcmp(token, own) != 0)
    return fail(PINDRIVE_BAD_VALUE, "the token must be %.60s, not %.60s", own, token);
  for (const char* kind = next_word(text); *kind; kind = next_word(text)) {
    Variable variable{};
    variable.kind = std::strcmp(kind, "parameter") == 0   ? Variable::parameter
                    : std::strcmp(kind, "input") == 0     ? Variable::input
                    : std::strcmp(kind, "command") == 0   ? Variable::command
                    : std::strcmp(kind, "luminance") == 0 ? Variable::luminance
                                                          : Variable::output;
    variable.name = next_word(text);
    variable.place = place_of(variable.kind, variable.name);
    const char* const bits = next_word(text);
    const bool placed = variable.kind == Variable::input || variable.kind == Variable::output;
    if (std::strlen(bits) != 16 || (placed && variable.place < 0))
      return fail(PINDRIVE_BAD_VALUE, "the line of %.60s cannot be read in %.120s", variable.name,
                  path);
    const std::uint64_t number = std::strtoull(bits, nullptr, 16);
    std::memcpy(&variable.start, &number, sizeof number);
    variables.push_back(variable);
  }
  return PINDRIVE_OK;
}

}  // namespace pindrive_fmu
