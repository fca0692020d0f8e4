extends SceneTree
# Hears a VMC sender with the add-on "Godot VMC Tracker" and prints where its body tracker has the joints, as JSON.
# Call: godot --headless --path PROJECT --script res://hear.gd -- PORT

const HEARD := 60 # frames after the first data: whole frames of the sender have come by then

var _frames := 0


func _initialize() -> void:
	var tracker: Node = load("res://addons/godot_vmc_tracker/vmc_tracker.gd").new()
	tracker.udp_listener_port = int(OS.get_cmdline_user_args()[0])
	root.add_child(tracker)
	print("ready")


func _process(_delta: float) -> bool:
	var body: XRBodyTracker = XRServer.get_tracker("/vmc/body_tracker")
	if body and body.has_tracking_data:
		_frames += 1
	if _frames < HEARD:
		return false
	var places := {}
	for joint in VMCBody.JOINT_MAPPING:
		var at: Vector3 = body.get_joint_transform(joint["body"]).origin
		places[VMCBody.JOINT_NAMES.find_key(joint["native"])] = [at.x, at.y, at.z]
	var version: String = Engine.get_version_info()["string"]
	print(JSON.stringify({"version": version, "places": places}))
	return true
