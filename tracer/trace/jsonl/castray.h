// castray.h: logs what a recursive castRay does, for `castray log` and `castray doctor`.
// C++11, no dependency. Everything is a macro: with CASTRAY_OFF defined nothing of it is compiled.
//
//     #include "castray.h"
//
//     CASTRAY_PATH(x, y, sample);                        // in the render loop, before each castRay
//
//     Vector3f castRay(const Ray &ray, int depth) {
//         CASTRAY_CALL(ray.origin, ray.direction, depth);  // first line of castRay
//         ...
//         CASTRAY_LOG("hit.p", p, "hit.n", N);             // any number of names and values
//         ...
//         return CASTRAY_RETURN(L_dir + L_indir);          // instead of every return L
//     }
//
// Names are those of `castray log --schema`; more of them means more that can be checked:
//     hit.p hit.n hit.Le
//     light.q light.nq light.Le light.f light.cos light.pdf_area (or light.pdf) light.visible
//     roulette.probability roulette.survived
//     bounce.wi bounce.f bounce.cos bounce.pdf
//     direct indirect emission                             // the terms of the sum that is returned
// wi and wo both lead away from the surface, f is without the cosine, pdf is per solid angle.
// A vector is anything with members x y z, functions x() y() z(), or [0] [1] [2].
//
// The log is castray.jsonl, or what the environment's CASTRAY_LOG names. By default it has every 16th pixel
// in x and y with all samples; CASTRAY_PIXELS=8 takes every 8th, CASTRAY_PIXELS=all all of them, and
// CASTRAY_PIXELS="200,150 10,12" two pixels. Lines are written when a call returns, and survive a crash.
//
// Before the include these may be defined:
//     CASTRAY_HEADER   what else the log's first line declares, e.g.
//                      "\"width\": 784, \"height\": 784, \"spp\": 16, \"jitter\": false"
//     CASTRAY_DIGITS   significant digits (9), CASTRAY_BITS 32 or 64: of the program's own numbers (32)

#ifndef CASTRAY_H
#define CASTRAY_H

#ifdef CASTRAY_OFF

#define CASTRAY_PATH(x, y, sample) ((void)0)
#define CASTRAY_CALL(origin, direction, depth) ((void)0)
#define CASTRAY_LOG(...) ((void)0)
#define CASTRAY_RETURN(value) (value)

#else

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <string>
#include <type_traits>

#ifndef CASTRAY_HEADER
#define CASTRAY_HEADER ""
#endif
#ifndef CASTRAY_DIGITS
#define CASTRAY_DIGITS 9
#endif
#ifndef CASTRAY_BITS
#define CASTRAY_BITS 32
#endif

namespace castray_log {

// ---- numbers and vectors as JSON ----

inline void put(std::string &out, double value) {
    if (std::isnan(value)) { out += "null"; return; }
    if (std::isinf(value)) { out += value > 0 ? "\"inf\"" : "\"-inf\""; return; }
    char text[40];
    std::snprintf(text, sizeof text, "%.*g", CASTRAY_DIGITS, value);
    for (char *c = text; *c; ++c)
        if (*c == ',') *c = '.';  // some locales
    out += text;
}

inline void put3(std::string &out, double a, double b, double c) {
    out += '[';
    put(out, a);
    out += ',';
    put(out, b);
    out += ',';
    put(out, c);
    out += ']';
}

template <int N> struct Rank : Rank<N - 1> {};
template <> struct Rank<0> {};

// a number, true or false
template <class T>
typename std::enable_if<std::is_arithmetic<T>::value>::type value(std::string &out, const T &v, Rank<3>) {
    if (std::is_same<T, bool>::value) out += v ? "true" : "false";
    else put(out, static_cast<double>(v));
}

// members x y z
template <class V>
auto value(std::string &out, const V &v, Rank<2>)
    -> decltype(static_cast<double>(v.x), static_cast<double>(v.z), void()) {
    put3(out, static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
}

// functions x() y() z()
template <class V>
auto value(std::string &out, const V &v, Rank<1>)
    -> decltype(static_cast<double>(v.x()), static_cast<double>(v.z()), void()) {
    put3(out, static_cast<double>(v.x()), static_cast<double>(v.y()), static_cast<double>(v.z()));
}

// [0] [1] [2]
template <class V>
auto value(std::string &out, const V &v, Rank<0>) -> decltype(static_cast<double>(v[0]), void()) {
    put3(out, static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2]));
}

// ---- the file ----

class File {
  public:
    static File &one() {
        static File file;
        return file;
    }
    void line(const std::string &text) {
        std::lock_guard<std::mutex> guard(lock_);
        if (!file_) return;
        std::fwrite(text.data(), 1, text.size(), file_);
        std::fflush(file_);  // so that it is there whatever happens next
    }
    // Whether a pixel is one of those that are logged.
    bool wants(long x, long y) const {
        if (!file_) return false;
        if (listed_.empty()) return x % every_ == every_ / 2 % every_ && y % every_ == every_ / 2 % every_;
        char key[64];
        std::snprintf(key, sizeof key, " %ld,%ld ", x, y);
        return listed_.find(key) != std::string::npos;
    }
    long next_path() {
        std::lock_guard<std::mutex> guard(lock_);
        return paths_++;
    }

  private:
    File() : file_(nullptr), every_(16), paths_(0) {
        const char *pixels = std::getenv("CASTRAY_PIXELS");
        if (pixels && std::strcmp(pixels, "all") == 0) every_ = 1;
        else if (pixels && std::strchr(pixels, ',')) listed_ = " " + std::string(pixels) + " ";
        else if (pixels && std::atol(pixels) > 0) every_ = std::atol(pixels);
        for (std::size_t at = 0; (at = listed_.find(' ', at)) != std::string::npos; at += 2)
            listed_.insert(at, " ");  // each pixel between blanks of its own
        const char *name = std::getenv("CASTRAY_LOG");
        file_ = std::fopen(name && *name ? name : "castray.jsonl", "wb");
        if (!file_) {
            std::fprintf(stderr, "castray.h: the log cannot be written\n");
            return;
        }
        char text[200];
        std::snprintf(text, sizeof text, "{\"castray\": 1, \"tracer\": \"castray.h\", \"digits\": %d, \"bits\": %d%s",
                      CASTRAY_DIGITS, CASTRAY_BITS, CASTRAY_HEADER[0] ? ", " : "");
        std::fprintf(file_, "%s%s}\n", text, CASTRAY_HEADER);
        std::fflush(file_);
    }
    ~File() {
        if (file_) std::fclose(file_);
        file_ = nullptr;
    }
    File(const File &);
    File &operator=(const File &);

    std::FILE *file_;
    long every_, paths_;
    std::string listed_;
    std::mutex lock_;
};

// ---- one call, for as long as it runs; calls within it find it by `here` ----

struct Call;

struct Path {  // of this thread
    bool on;
    long x, y, sample, number;
    int calls;
    Call *here;
};

inline Path &path() {
    static thread_local Path of_thread = {false, 0, 0, 0, 0, 0, nullptr};
    return of_thread;
}

inline void begin(long x, long y, long sample) {
    Path &p = path();
    p.on = File::one().wants(x, y);
    p.x = x;
    p.y = y;
    p.sample = sample;
    p.here = nullptr;
}

struct Call {
    template <class O, class D> Call(const O &origin, const D &direction, int depth) : on_(path().on) {
        if (!on_) return;
        Path &p = path();
        outer_ = p.here;
        p.here = this;
        if (!outer_) {
            p.number = File::one().next_path();
            p.calls = 0;
        }
        number_ = p.calls++;
        char text[160];
        std::snprintf(text, sizeof text,
                      "{\"path\":%ld,\"x\":%ld,\"y\":%ld,\"sample\":%ld,\"call\":%d,\"parent\":%d,\"depth\":%d",
                      p.number, p.x, p.y, p.sample, number_, outer_ ? outer_->number_ : -1, depth);
        text_.reserve(1024);
        text_ = text;
        log("ray.o", origin, "ray.d", direction);
    }
    ~Call() {
        if (!on_) return;
        path().here = outer_;
        text_ += "}\n";
        File::one().line(text_);
    }
    void log() {}
    template <class V, class... Rest> void log(const char *name, const V &v, const Rest &...rest) {
        if (!on_) return;
        text_ += ",\"";
        text_ += name;
        text_ += "\":";
        value(text_, v, Rank<3>());
        log(rest...);
    }
    template <class V> const V &returned(const V &v) {
        log("returned", v);
        return v;
    }

  private:
    Call(const Call &);
    Call &operator=(const Call &);

    bool on_;
    int number_;
    Call *outer_;
    std::string text_;
};

}  // namespace castray_log

#define CASTRAY_PATH(x, y, sample) ::castray_log::begin((x), (y), (sample))
#define CASTRAY_CALL(origin, direction, depth) ::castray_log::Call castray_call((origin), (direction), (depth))
#define CASTRAY_LOG(...) castray_call.log(__VA_ARGS__)
#define CASTRAY_RETURN(value) castray_call.returned(value)

#endif  // CASTRAY_OFF
#endif  // CASTRAY_H
