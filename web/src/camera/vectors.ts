/** Points, directions and rotations of the camera's geometry, as plain numbers. */

/** Metres, or a direction: x, y, z. */
export type Vec3 = readonly [number, number, number];
/** A rotation as a unit quaternion: x, y, z, w. */
export type Quat = readonly [number, number, number, number];
