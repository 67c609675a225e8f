"""Jobs: words and files become requests and cases, and what comes of them goes back; every face calls these."""
