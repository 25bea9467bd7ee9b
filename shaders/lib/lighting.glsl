// A headlight: the light sits at the eye, both sides are lit. Ambient 0.2, diffuse 0.7, white specular 0.2 with power 20, as VTK's
// volume mapper has them, so that pictures compare. Without a normal only the ambient share is left.
vec3 lit(vec3 color, vec3 normal, vec3 towards_eye) {
  const float length2 = dot(normal, normal);
  if (!(length2 > 0.0)) return 0.2 * color;
  const float n = min(1.0, abs(dot(normal, towards_eye)) * inversesqrt(length2));
  const float mirrored = max(0.0, 2.0 * n * n - 1.0);
  return (0.2 + 0.7 * n) * color + 0.2 * pow(mirrored, 20.0);
}
