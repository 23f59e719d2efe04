#include "apps/picture/draw.h"

#include <cmath>
#include <limits>

namespace picture {

using namespace lendulet;

namespace {

constexpr int samples = 3;         // per pixel and axis
constexpr int shadow_size = 4096;  // texels along an edge of the shadow map
constexpr float near_plane = 0.05f;
constexpr Vec3 zenith{0.20f, 0.36f, 0.62f}, horizon{0.72f, 0.79f, 0.86f};
constexpr Vec3 sun{0.92f, 0.87f, 0.78f}, ambient{0.20f, 0.23f, 0.30f};
const Vec3 to_sun = normalize(Vec3{0.45f, 0.8f, 0.4f});

// A corner on the screen: pixel coordinates and what is interpolated across the triangle.
struct Corner {
    float x, y, depth;  // depth: 1 / distance along the view for perspective, distance for the shadow map
    Vec3 world, normal;
};

// Calls cover(x, y, weights) for every pixel centre inside the triangle.
template <class Cover>
void rasterise(const Corner (&c)[3], int width, int height, Cover&& cover) {
    float area = (c[1].x - c[0].x) * (c[2].y - c[0].y) - (c[1].y - c[0].y) * (c[2].x - c[0].x);
    if (!(std::abs(area) > 1e-12f)) return;
    auto range = [](float a, float b, float d, int size, int& first, int& last) {
        float low = minimum(a, minimum(b, d)), high = maximum(a, maximum(b, d));
        first = static_cast<int>(clamp(std::ceil(low - 0.5f), 0.0f, static_cast<float>(size)));
        last = static_cast<int>(clamp(std::floor(high - 0.5f), -1.0f, static_cast<float>(size - 1)));
    };
    int left, right, top, bottom;
    range(c[0].x, c[1].x, c[2].x, width, left, right);
    range(c[0].y, c[1].y, c[2].y, height, top, bottom);
    for (int y = top; y <= bottom; ++y) {
        for (int x = left; x <= right; ++x) {
            float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
            float w1 = ((px - c[0].x) * (c[2].y - c[0].y) - (py - c[0].y) * (c[2].x - c[0].x)) / area;
            float w2 = ((c[1].x - c[0].x) * (py - c[0].y) - (c[1].y - c[0].y) * (px - c[0].x)) / area;
            float w0 = 1.0f - w1 - w2;
            if (w0 >= 0.0f && w1 >= 0.0f && w2 >= 0.0f) cover(x, y, w0, w1, w2);
        }
    }
}

// Depth along the light over a square that holds the region of interest.
class ShadowMap {
public:
    ShadowMap(const std::vector<Painted>& triangles, Vec3 centre, float radius)
        : centre_(centre),
          scale_(shadow_size / (2.0f * radius)),
          right_(perpendicular(to_sun)),
          up_(cross(to_sun, right_)) {
        depth_.assign(static_cast<size_t>(shadow_size) * shadow_size, std::numeric_limits<float>::max());
        for (const Painted& painted : triangles) {
            Corner c[3];
            for (int i = 0; i < 3; ++i) c[i] = project(painted.triangle.corners[i]);
            rasterise(c, shadow_size, shadow_size, [&](int x, int y, float w0, float w1, float w2) {
                float& depth = depth_[static_cast<size_t>(y) * shadow_size + static_cast<size_t>(x)];
                depth = minimum(depth, w0 * c[0].depth + w1 * c[1].depth + w2 * c[2].depth);
            });
        }
    }

    bool lit(Vec3 point, Vec3 normal) const {
        float texel = 1.0f / scale_;
        Corner c = project(point + (1.5f * texel) * normal);  // away from the surface, which must not shade itself
        int x = static_cast<int>(c.x), y = static_cast<int>(c.y);
        if (!(c.x >= 0.0f && c.y >= 0.0f) || x >= shadow_size || y >= shadow_size) return true;
        return c.depth <= depth_[static_cast<size_t>(y) * shadow_size + static_cast<size_t>(x)] + 2.0f * texel;
    }

private:
    Corner project(Vec3 point) const {
        Vec3 p = point - centre_;
        float half = shadow_size / 2.0f;
        return {half + scale_ * dot(p, right_), half + scale_ * dot(p, up_), -dot(p, to_sun), {}, {}};
    }

    Vec3 centre_;
    float scale_;
    Vec3 right_, up_;
    std::vector<float> depth_;
};

struct View {
    Vec3 eye, right, up, forward;
    float focal;  // pixels
    int width, height;

    Vec3 to_view(Vec3 p) const { return {dot(p - eye, right), dot(p - eye, up), dot(p - eye, forward)}; }
    Corner project(Vec3 world, Vec3 normal) const {
        Vec3 p = to_view(world);
        return {static_cast<float>(width) / 2.0f + focal * p.x / p.z,
                static_cast<float>(height) / 2.0f - focal * p.y / p.z, 1.0f / p.z, world, normal};
    }
};

View make_view(const Camera& camera, int width, int height) {
    Vec3 forward = normalize(camera.target - camera.eye);
    Vec3 right = normalize(cross(forward, {0.0f, 1.0f, 0.0f}));
    float focal = static_cast<float>(height) / (2.0f * camera.tangent_half_fov);
    return {camera.eye, right, cross(right, forward), forward, focal, width, height};
}

// Cuts a triangle at the near plane into at most two and hands each to `use`.
template <class Use>
void clip_near(const View& view, const Triangle& t, Use&& use) {
    Vec3 points[4], normals[4];
    int count = 0;
    for (int i = 0; i < 3; ++i) {
        int j = (i + 1) % 3;
        float a = view.to_view(t.corners[i]).z - near_plane, b = view.to_view(t.corners[j]).z - near_plane;
        if (a >= 0.0f) {
            points[count] = t.corners[i];
            normals[count++] = t.normals[i];
        }
        if ((a >= 0.0f) != (b >= 0.0f)) {
            float s = a / (a - b);
            points[count] = t.corners[i] + s * (t.corners[j] - t.corners[i]);
            normals[count++] = t.normals[i] + s * (t.normals[j] - t.normals[i]);
        }
    }
    for (int i = 2; i < count; ++i)
        use(Triangle{{points[0], points[i - 1], points[i]}, {normals[0], normals[i - 1], normals[i]}});
}

Vec3 sky(const View& view, int x, int y) {
    float right = (static_cast<float>(x) - 0.5f * static_cast<float>(view.width)) / view.focal;
    float up = (0.5f * static_cast<float>(view.height) - static_cast<float>(y)) / view.focal;
    float height = clamp(2.0f * normalize(view.forward + right * view.right + up * view.up).y, 0.0f, 1.0f);
    return (1.0f - height) * horizon + height * zenith;
}

Vec3 shade(Vec3 colour, Vec3 point, Vec3 normal, Vec3 eye, const ShadowMap& shadows) {
    float facing = dot(normal, to_sun);
    float sunlight = facing > 0.0f && shadows.lit(point, normal) ? facing : 0.0f;
    Vec3 light = sunlight * sun + (0.75f + 0.25f * normal.y) * ambient;
    Vec3 half = normalize(to_sun + normalize(eye - point));
    float gloss = maximum(dot(normal, half), 0.0f);
    for (int i = 0; i < 5; ++i) gloss *= gloss;
    return multiply(colour, light) + (sunlight > 0.0f ? 0.12f * gloss : 0.0f) * sun;
}

uint8_t to_byte(float linear) {
    return static_cast<uint8_t>(255.0f * std::pow(clamp(linear, 0.0f, 1.0f), 1.0f / 2.2f) + 0.5f);
}

Image reduce(const std::vector<Vec3>& fine, int width, int height) {
    Image image{width, height, {}};
    image.rgb.reserve(static_cast<size_t>(width) * static_cast<size_t>(height) * 3);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            Vec3 sum{};
            for (int j = 0; j < samples; ++j) {
                for (int i = 0; i < samples; ++i) {
                    Vec3 c = fine[static_cast<size_t>((y * samples + j) * width * samples + x * samples + i)];
                    sum += minimum(c, Vec3{1.0f, 1.0f, 1.0f});
                }
            }
            Vec3 mean = (1.0f / (samples * samples)) * sum;
            for (int k = 0; k < 3; ++k) image.rgb.push_back(to_byte(component(mean, k)));
        }
    }
    return image;
}

}  // namespace

Image draw(const std::vector<Painted>& triangles, const Camera& camera, int width, int height) {
    View view = make_view(camera, width * samples, height * samples);
    float distance = length(camera.target - camera.eye);
    ShadowMap shadows(triangles, camera.target, 0.8f * distance);
    std::vector<Vec3> colours(static_cast<size_t>(view.width) * static_cast<size_t>(view.height));
    std::vector<float> depths(colours.size(), 0.0f);
    for (int y = 0; y < view.height; ++y) {
        for (int x = 0; x < view.width; ++x) colours[static_cast<size_t>(y * view.width + x)] = sky(view, x, y);
    }
    for (const Painted& painted : triangles) {
        clip_near(view, painted.triangle, [&](const Triangle& t) {
            Corner c[3];
            for (int i = 0; i < 3; ++i) c[i] = view.project(t.corners[i], t.normals[i]);
            rasterise(c, view.width, view.height, [&](int x, int y, float w0, float w1, float w2) {
                // 1 / distance is linear on the screen; what lies on the triangle is linear after division by distance.
                float inverse = w0 * c[0].depth + w1 * c[1].depth + w2 * c[2].depth;
                size_t pixel = static_cast<size_t>(y * view.width + x);
                if (inverse <= depths[pixel]) return;
                depths[pixel] = inverse;
                float a = w0 * c[0].depth / inverse, b = w1 * c[1].depth / inverse, d = w2 * c[2].depth / inverse;
                Vec3 point = a * c[0].world + b * c[1].world + d * c[2].world;
                Vec3 normal = normalize(a * c[0].normal + b * c[1].normal + d * c[2].normal);
                Vec3 colour = shade(painted.colour, point, normal, camera.eye, shadows);
                float haze = clamp((1.0f / inverse - 1.5f * distance) / (6.0f * distance), 0.0f, 1.0f);
                colours[pixel] = (1.0f - haze) * colour + haze * horizon;
            });
        });
    }
    return reduce(colours, width, height);
}

}  // namespace picture
