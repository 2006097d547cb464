"""zenoh-pico, with rmw_zenoh_pico below rclc."""
