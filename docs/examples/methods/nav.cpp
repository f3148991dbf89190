// Dead reckoning in C++, as a program of its own: c++ -O2 -o nav nav.cpp
// Reads rows of t, gyro x y z, accel x y z (little-endian doubles; s, rad/s, m/s2) and writes a track as CSV.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;  // rows
const double gravity = 9.80665, rest_s = 25.0, pi = std::acos(-1.0);

[[noreturn]] void fail(const std::string &why) {
    std::fprintf(stderr, "%s\n", why.c_str());  // its last line is what Footfall tells
    std::exit(1);
}

Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double norm(const Vector &a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

Vector times(const Matrix &m, const Vector &a) {
    Vector out{};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) out[i] += m[i][j] * a[j];
    return out;
}

// Body to world after a further turn (rotation vector, rad, in the body): Rodrigues.
Matrix turned(const Matrix &m, const Vector &by) {
    const double angle = norm(by), s = angle > 1e-12 ? std::sin(angle) / angle : 1.0,
                 c = angle > 1e-12 ? (1 - std::cos(angle)) / (angle * angle) : 0.5;
    Matrix out{};
    for (int j = 0; j < 3; j++) {
        Vector unit{}, once, twice, column;
        unit[j] = 1;
        once = cross(by, unit);
        twice = cross(by, once);
        for (int i = 0; i < 3; i++) column[i] = unit[i] + s * once[i] + c * twice[i];
        column = times(m, column);
        for (int i = 0; i < 3; i++) out[i][j] = column[i];
    }
    return out;
}

std::string text_of(const char *path) {
    std::FILE *file = std::fopen(path, "rb");
    if (!file) fail(std::string(path) + ": cannot be read");
    std::string text;
    for (int c; (c = std::fgetc(file)) != EOF;) text += char(c);
    std::fclose(file);
    return text;
}

// The number after "key": in a JSON object, past brackets; `otherwise` where there is none.
double number(const std::string &json, const char *key, int which = 0, double otherwise = 0) {
    size_t at = json.find(std::string("\"") + key + "\":");
    if (at == std::string::npos) return otherwise;
    at = json.find(':', at) + 1;
    for (; which > 0; which--) at = json.find(',', at) + 1;
    at = json.find_first_not_of(" [", at);
    return std::strtod(json.c_str() + at, nullptr);
}

int main(int count, char **words) {
    const char *in = nullptr, *out = nullptr, *start_path = nullptr, *set_path = nullptr;
    for (int i = 1; i + 1 < count; i += 2) {
        if (!std::strcmp(words[i], "--in")) in = words[i + 1];
        if (!std::strcmp(words[i], "--out")) out = words[i + 1];
        if (!std::strcmp(words[i], "--start")) start_path = words[i + 1];
        if (!std::strcmp(words[i], "--set")) set_path = words[i + 1];
    }
    if (!in || !out || !start_path || !set_path) fail("usage: nav --in F64 --out CSV --start JSON --set JSON");
    const std::string bytes = text_of(in), start = text_of(start_path), set = text_of(set_path);
    const double still_rate = number(set, "still_rate", 0, 1.0);  // rad/s, below which the foot may be at rest
    const size_t n = bytes.size() / (7 * sizeof(double));
    std::vector<std::array<double, 7>> rows(n);
    std::memcpy(rows.data(), bytes.data(), n * 7 * sizeof(double));
    if (n < 2 || rows[n - 1][0] - rows[0][0] < rest_s) fail("too short: expected 25 s at rest and a walk");

    // At rest: the gyro's bias and which way is up.
    Vector bias{}, up{};
    size_t k = 1;
    for (; k < n && rows[k][0] - rows[0][0] <= rest_s + 1e-6; k++)
        for (int i = 0; i < 3; i++) bias[i] += rows[k][1 + i], up[i] += rows[k][4 + i];
    const size_t last = k - 1;
    for (int i = 0; i < 3; i++) bias[i] /= double(last);
    const double length = norm(up);
    for (double &value : up) value /= length;
    Vector forward = {1 - up[0] * up[0], -up[0] * up[1], -up[0] * up[2]};
    const double level = norm(forward);
    for (double &value : forward) value /= level;
    const Vector left = cross(up, forward);
    double heading = number(start, "heading_rad");
    const double c = std::cos(heading), s = std::sin(heading);
    Matrix attitude{};  // rows: x, y and z of the world in the body
    for (int j = 0; j < 3; j++)
        attitude[0][j] = c * forward[j] - s * left[j], attitude[1][j] = s * forward[j] + c * left[j], attitude[2][j] = up[j];

    Vector velocity{}, position = {number(start, "position_m"), number(start, "position_m", 1), number(start, "position_m", 2)};
    std::FILE *file = std::fopen(out, "wb");
    if (!file) fail(std::string(out) + ": cannot be written");
    std::fprintf(file, "t,x,y,z,heading\n");
    auto row = [&](double t) {
        const double now = std::atan2(attitude[1][0], attitude[0][0]);
        heading += std::remainder(now - heading, 2 * pi);  // unwrapped
        std::fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g\n", t, position[0], position[1], position[2], heading);
    };
    row(rows[last][0]);
    double still_since = rows[last][0], told = rows[last][0];
    for (k = last + 1; k < n; k++) {
        const double t = rows[k][0], dt = t - rows[k - 1][0];
        Vector rate, half, force;
        for (int i = 0; i < 3; i++) rate[i] = rows[k][1 + i] - bias[i], half[i] = rate[i] * dt / 2, force[i] = rows[k][4 + i];
        const Matrix middle = turned(attitude, half);
        attitude = turned(middle, half);
        Vector push = times(middle, force);
        push[2] -= gravity;
        const Vector before = velocity;
        for (int i = 0; i < 3; i++) velocity[i] += push[i] * dt, position[i] += (before[i] + velocity[i]) / 2 * dt;
        if (norm(rate) > still_rate || std::fabs(norm(force) - gravity) > 4) still_since = t;
        if (t - still_since < 0.1) continue;
        velocity = {};  // a foot that is at rest
        if (told < still_since && t - told > 0.4) row(told = t);
    }
    std::fclose(file);
}
