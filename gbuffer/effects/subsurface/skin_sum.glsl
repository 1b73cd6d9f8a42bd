// The sum of unblurred light and of GAUSSIANS blurs of it, of which the widest is at hand.
uniform sampler2D skin_light, skin_gaussian_1, skin_gaussian_2;
#if GAUSSIANS > 3
uniform sampler2D skin_gaussian_3;
#endif
#if GAUSSIANS > 4
uniform sampler2D skin_gaussian_4;
#endif

const float shares[] = SHARES;  // of red, green and blue, for each

vec3 share(int i, vec3 light) { return vec3(shares[3 * i], shares[3 * i + 1], shares[3 * i + 2]) * light; }

vec3 sum_of_gaussians(ivec2 pixel, vec3 widest) {
    vec3 sum = share(0, texelFetch(skin_light, pixel, 0).rgb) + share(1, texelFetch(skin_gaussian_1, pixel, 0).rgb) +
               share(2, texelFetch(skin_gaussian_2, pixel, 0).rgb);
#if GAUSSIANS > 3
    sum += share(3, texelFetch(skin_gaussian_3, pixel, 0).rgb);
#endif
#if GAUSSIANS > 4
    sum += share(4, texelFetch(skin_gaussian_4, pixel, 0).rgb);
#endif
    return sum + share(GAUSSIANS, widest);
}
