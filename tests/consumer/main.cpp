#include <core/asset.hpp>
#include <factorize/reflectance.hpp>
#include <iostream>

int main() {
    nacre::Image ramp(2, 1, 1);
    ramp.at(1, 0, 0) = 0.5f;
    const nacre::AssetTexture texture = nacre::makeTexture("ramp", "uv", ramp, nacre::TexelFormat::Half);
    std::cout << "half way: " << nacre::sampleBilinear(texture.image, 0.5f, 0.5f).x << '\n';
    return nacre::sampleBilinear(texture.image, 0.5f, 0.5f).x == 0.25f ? 0 : 1;
}
