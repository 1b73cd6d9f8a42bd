// The camera that a scene is seen by, and what its ray meets.
uniform mat3 to_view;  // from the world's axes to the camera's
uniform vec3 eye;

struct Hit {
    float t;  // the distance; 0 where nothing is met
    vec3 n;   // towards the outside, in the world's axes
    int material;
};

const Hit NOTHING = Hit(0.0, vec3(0.0), 0);
