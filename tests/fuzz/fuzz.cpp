// Draws drives and inputs over many decades, runs each and judges it by the laws of motion alone.
//
//   fuzz COUNT SEED [--from NUMBER] [--threads N] [--log FILE] [--family NAME]
//   fuzz --replay FILE…
//
// The cases NUMBER … NUMBER + COUNT − 1 of a seed; the result does not depend on the threads. The
// log is brought up to date once a minute, and a run goes on from where its log ends. A motion that
// fails is written to fuzz-SEED-CASE.txt, to be replayed and kept in tests/hard.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <thread>
#include <vector>

#include "judge.hpp"
#include "totals.hpp"

namespace {

using namespace fuzz;

volatile std::sig_atomic_t interrupted = 0;

struct Options {
  Range range;
  int threads{1};
  std::string log;
};

// ---- one stretch of cases ------------------------------------------------------------------------

/// One drive in eight is judged thoroughly.
constexpr long long one_in = 8;

Verdict judged(const Range& range, long long number, std::vector<pd::Segment<double>>& segments) {
  return judge(range.at(number), number % one_in == 0, segments);
}

/// The cases begin … end − 1, taken by the threads a few at a time.
Totals stretch(const Options& options, long long begin, long long end) {
  constexpr long long few = 64;
  std::atomic<long long> next{begin};
  std::vector<Totals> found(static_cast<std::size_t>(options.threads));
  const auto work = [&](Totals& totals) {
    std::vector<pd::Segment<double>> segments;
    for (;;) {
      const long long first = next.fetch_add(few);
      if (first >= end || interrupted != 0) return;
      for (long long i = first; i < std::min(first + few, end); ++i)
        totals.add(i, judged(options.range, i, segments));
    }
  };
  std::vector<std::thread> others;
  for (std::size_t i = 1; i < found.size(); ++i) others.emplace_back(work, std::ref(found[i]));
  work(found[0]);
  for (std::thread& thread : others) thread.join();
  Totals all;
  for (const Totals& part : found) all.add(part);
  return all;
}

/// Writes a case that failed to a file; the first twenty of a run.
void report(const Options& options, const Totals& before, const Totals& found) {
  std::size_t count = before.failed.size();
  std::vector<pd::Segment<double>> segments;
  for (const long long number : found.failed) {
    if (++count > 20) return;
    const std::string name =
        "fuzz-" + std::to_string(options.range.seed) + "-" + std::to_string(number) + ".txt";
    std::ofstream file(name);
    write(file, options.range.at(number));
    print(name.c_str(), judged(options.range, number, segments));
    std::fflush(stdout);
  }
}

// ---- a run ---------------------------------------------------------------------------------------

void progress(const Options& options, const Totals& totals, long long done, double seconds) {
  const double rate = static_cast<double>(done) / seconds;
  const auto left = static_cast<double>(options.range.count - totals.drives);
  std::fprintf(stderr, "%lld of %lld drives, %.0f a second, %.0f min left, %zu failed\n",
               totals.drives, options.range.count, rate, left / rate / 60, totals.failed.size());
}

/// Continues from the log of an earlier run, if there is one; false for a log of other cases.
bool take_up(const Options& options, Totals& totals) {
  std::ifstream in(options.log);
  if (options.log.empty() || !in) return true;
  Range range;
  if (read(in, range, totals) && range == options.range) return true;
  std::fprintf(stderr, "fuzz: %s is not the log of seed %lld from %lld, family %s\n",
               options.log.c_str(), options.range.seed, options.range.from,
               families[static_cast<std::size_t>(options.range.family)]);
  return false;
}

int run(const Options& options) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point then) {
    return std::chrono::duration<double>(Clock::now() - then).count();
  };
  Totals totals;
  if (!take_up(options, totals)) return 2;
  const Clock::time_point start = Clock::now();
  Clock::time_point saved = start;
  const long long already = totals.drives;
  const auto save_log = [&] {
    saved = Clock::now();
    if (options.log.empty() || save(options.log, options.range, totals)) return true;
    std::fprintf(stderr, "fuzz: %s cannot be written\n", options.log.c_str());
    return false;
  };
  const long long end = options.range.from + options.range.count;
  while (totals.drives < options.range.count) {
    const Clock::time_point begun = Clock::now();
    const long long first = options.range.from + totals.drives;
    Totals found = stretch(options, first, std::min(first + 100'000, end));
    if (interrupted != 0) break;  // what is begun and not finished is done again
    found.seconds = since(begun);
    report(options, totals, found);
    totals.add(found);
    if (since(saved) < 60) continue;
    progress(options, totals, totals.drives - already, since(start));
    if (!save_log()) return 2;
  }
  if (!save_log()) return 2;
  std::cout << std::setprecision(2);
  write(std::cout, options.range, totals);
  if (interrupted != 0) return 130;
  return totals.failed.empty() ? 0 : 1;
}

int replay(const std::vector<std::string>& files) {
  std::vector<pd::Segment<double>> segments;
  int bad = 0;
  for (const std::string& name : files) {
    std::ifstream file(name);
    Case c;
    if (!read(file, c)) {
      std::fprintf(stderr, "fuzz: %s cannot be read as a drive\n", name.c_str());
      return 2;
    }
    const Verdict verdict = judge(c, true, segments);
    print(name.c_str(), verdict);
    bad += verdict.good() ? 0 : 1;
  }
  std::printf("%zu drives replayed, %d failed\n", files.size(), bad);
  return bad == 0 ? 0 : 1;
}

// ---- the command line ----------------------------------------------------------------------------

/// A whole number from 0 on; false if the text is none.
bool whole(const std::string& text, long long& number) {
  if (text.empty() || text.size() > 18) return false;
  if (text.find_first_not_of("0123456789") != std::string::npos) return false;
  number = std::stoll(text);
  return true;
}

bool parse(const std::vector<std::string>& words, Options& options) {
  if (words.size() < 2 || words.size() % 2 != 0) return false;
  if (!whole(words[0], options.range.count) || !whole(words[1], options.range.seed)) return false;
  for (std::size_t i = 2; i < words.size(); i += 2) {
    const std::string& value = words[i + 1];
    long long threads = 1;
    if (words[i] == "--from" && whole(value, options.range.from)) continue;
    if (words[i] == "--family" && read(value, options.range.family)) continue;
    if (words[i] == "--threads" && whole(value, threads) && threads >= 1 && threads <= 1024)
      options.threads = static_cast<int>(threads);
    else if (words[i] == "--log" && !value.empty())
      options.log = value;
    else
      return false;
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() > 1 && words[0] == "--replay") {
    words.erase(words.begin());
    return replay(words);
  }
  Options options;
  if (!parse(words, options)) {
    std::fprintf(stderr,
                 "usage: fuzz COUNT SEED [--from NUMBER] [--threads N] [--log FILE]\n"
                 "                       [--family "
                 "any|aligned|oblique|stops|skin|functions|laws|strokes|damped|round]\n"
                 "       fuzz --replay FILE...\n");
    return 2;
  }
  const auto interrupt = [](int signal) {
    interrupted = 1;
    std::signal(signal, SIG_DFL);  // asked twice, it does not wait for the drives at work
  };
  std::signal(SIGINT, interrupt);
  std::signal(SIGTERM, interrupt);
  return run(options);
}
