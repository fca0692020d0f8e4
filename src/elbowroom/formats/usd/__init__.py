"""USD in text: what it says as prims, and the skeletons of UsdSkel that are animated in it."""
