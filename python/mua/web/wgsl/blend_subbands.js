// Generated from ComputeShaders/blend_subbands.compute by tools/gen_wgsl.py; do not edit.

/** @type {import("../shader.js").Shader} */
export const BlendLl = {
  ...{"stage":"comp","entry":"BlendLl","buffers":[{"name":"mean","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"basis","binding":1,"read_only":true,"scalar":"uint","stride":4},{"name":"alpha","binding":4,"read_only":true,"scalar":"float","stride":4},{"name":"blended","binding":5,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"mean_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"basis_layout","offset":16,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"h_layout","offset":32,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"w_layout","offset":48,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"channels","offset":60,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"rank","offset":64,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":68,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"alpha_offset","offset":72,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":6,"threads":[64,1,1]},
  code: `struct Constants{@align(16)mean_layout_0:vec3u,@align(16)basis_layout_0:vec3u,@align(16)h_layout_0:vec3u,@align(16)w_layout_0:vec3u,@align(4)channels_0:u32,@align(16)rank_0:u32,@align(4)size_0:u32,@align(8)alpha_offset_0:u32,};
@binding(6)@group(0)var<uniform>Constants_0:Constants;
@binding(0)@group(0)var<storage,read>mean_0:array<u32>;
@binding(4)@group(0)var<storage,read>alpha_0:array<f32>;
@binding(1)@group(0)var<storage,read>basis_0:array<u32>;
@binding(5)@group(0)var<storage,read_write>blended_0:array<u32>;
fn rowWords_0(a:u32)->u32{return(a+1u)/2u;}
fn neighbours_0(a:u32,b:u32)->vec2u{return vec2u(a*Constants_0.size_0)+min(vec2u(b,b+1u),vec2u(Constants_0.size_0-1u));}
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn byteAt_0(a:u32,b:u32)->i32{return i32(a<<(24u-8u*b))>>24u;}
fn packHalves_0(a:vec2f)->u32{return pack2x16float(vec2f(a.x,0.0))|(pack2x16float(vec2f(a.y,0.0))<<16u);}
fn packBounded_0(a:vec2f)->u32{return packHalves_0(clamp(a,vec2f(-65504f),vec2f(65504f)));}
fn stored_0(a:vec3u,b:u32)->f32{var c=a.x;var d=mean_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(mean_0[h+i]));}}return f;}
fn storedPair_0(a:vec3u,b:vec2u)->vec2f{var c=stored_0(a,b.x);var d=stored_0(a,b.y);return vec2f(c,d);}
fn stored_1(a:vec3u,b:u32)->f32{var c=a.x;var d=basis_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(basis_0[h+i]));}}return f;}
fn storedPair_1(a:vec3u,b:vec2u)->vec2f{var c=stored_1(a,b.x);var d=stored_1(a,b.y);return vec2f(c,d);}
@compute@workgroup_size(64,1,1)fn BlendLl(@builtin(global_invocation_id)a:vec3u){var b=Constants_0.size_0*rowWords_0(Constants_0.size_0);var c=a.y;var d=a.x;var e=(d>=b)||(c>=Constants_0.channels_0);if(e){return;}var f=d/rowWords_0(Constants_0.size_0);var g=d%rowWords_0(Constants_0.size_0);var h=neighbours_0(f,2u*g);var i=Constants_0.size_0*Constants_0.size_0;var j=storedPair_0(Constants_0.mean_layout_0,vec2u(c*i)+h);var k=0u;var l=j;for(;k<Constants_0.rank_0;){var m=c*Constants_0.rank_0+k;var n=alpha_0[Constants_0.alpha_offset_0+m];var o=storedPair_1(Constants_0.basis_layout_0,vec2u(m*i)+h);var p=l+vec2f(n)*o;k=k+1u;l=p;}blended_0[c*b+d]=packBounded_0(l);}`,
};

/** @type {import("../shader.js").Shader} */
export const BlendDetail = {
  ...{"stage":"comp","entry":"BlendDetail","buffers":[{"name":"mean","binding":0,"read_only":true,"scalar":"uint","stride":4},{"name":"h","binding":2,"read_only":true,"scalar":"uint","stride":4},{"name":"w","binding":3,"read_only":true,"scalar":"uint","stride":4},{"name":"alpha","binding":4,"read_only":true,"scalar":"float","stride":4},{"name":"blended","binding":5,"read_only":false,"scalar":"uint","stride":4}],"constants":[{"name":"mean_layout","offset":0,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"basis_layout","offset":16,"scalar":"uint","shape":[3],"strides":[4],"used":false},{"name":"h_layout","offset":32,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"w_layout","offset":48,"scalar":"uint","shape":[3],"strides":[4],"used":true},{"name":"channels","offset":60,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"rank","offset":64,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"size","offset":68,"scalar":"uint","shape":[],"strides":[],"used":true},{"name":"alpha_offset","offset":72,"scalar":"uint","shape":[],"strides":[],"used":true}],"constants_binding":6,"threads":[12,8,1]},
  code: `struct Constants{@align(16)mean_layout_0:vec3u,@align(16)basis_layout_0:vec3u,@align(16)h_layout_0:vec3u,@align(16)w_layout_0:vec3u,@align(4)channels_0:u32,@align(16)rank_0:u32,@align(4)size_0:u32,@align(8)alpha_offset_0:u32,};
@binding(6)@group(0)var<uniform>Constants_0:Constants;
@binding(4)@group(0)var<storage,read>alpha_0:array<f32>;
@binding(2)@group(0)var<storage,read>h_0:array<u32>;
@binding(3)@group(0)var<storage,read>w_0:array<u32>;
@binding(0)@group(0)var<storage,read>mean_0:array<u32>;
@binding(5)@group(0)var<storage,read_write>blended_0:array<u32>;
var<workgroup>tileRows_0:array<f32,384>;
fn halfAt_0(a:u32,b:u32)->f32{return unpack2x16float((a>>(16u*b))&65535u).x;}
fn byteAt_0(a:u32,b:u32)->i32{return i32(a<<(24u-8u*b))>>24u;}
var<workgroup>tileColumns_0:array<f32,384>;
fn neighbours_0(a:u32,b:u32)->vec2u{return vec2u(a*Constants_0.size_0)+min(vec2u(b,b+1u),vec2u(Constants_0.size_0-1u));}
fn rowWords_0(a:u32)->u32{return(a+1u)/2u;}
fn packHalves_0(a:vec2f)->u32{return pack2x16float(vec2f(a.x,0.0))|(pack2x16float(vec2f(a.y,0.0))<<16u);}
fn packBounded_0(a:vec2f)->u32{return packHalves_0(clamp(a,vec2f(-65504f),vec2f(65504f)));}
fn stored_0(a:vec3u,b:u32)->f32{var c=a.x;var d=h_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(h_0[h+i]));}}return f;}
fn factor_0(a:vec3u,b:u32,c:u32,d:u32)->f32{var e=(c<Constants_0.rank_0)&&(d<Constants_0.size_0);var f:f32;if(e){var g=stored_0(a,(b*Constants_0.rank_0+c)*Constants_0.size_0+d);f=g;}else{f=0f;}return f;}
fn stored_1(a:vec3u,b:u32)->f32{var c=a.x;var d=w_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(w_0[h+i]));}}return f;}
fn factor_1(a:vec3u,b:u32,c:u32,d:u32)->f32{var e=(c<Constants_0.rank_0)&&(d<Constants_0.size_0);var f:f32;if(e){var g=stored_1(a,(b*Constants_0.rank_0+c)*Constants_0.size_0+d);f=g;}else{f=0f;}return f;}
fn stored_2(a:vec3u,b:u32)->f32{var c=a.x;var d=mean_0[b>>c];var e=b&((1u<<c)-1u);var f:f32;if(c==0u){f=bitcast<f32>(d|e);}else{if(c==1u){f=halfAt_0(d,e);}else{var g=f32(byteAt_0(d,e));var h=a.z;var i=b/a.y;f=g*(bitcast<f32>(mean_0[h+i]));}}return f;}
fn storedPair_0(a:vec3u,b:vec2u)->vec2f{var c=stored_2(a,b.x);var d=stored_2(a,b.y);return vec2f(c,d);}
@compute@workgroup_size(12,8,1)fn BlendDetail(@builtin(workgroup_id)a:vec3u,@builtin(local_invocation_id)b:vec3u,@builtin(local_invocation_index)c:u32){var d:u32;var e=a.z;var f=e%Constants_0.channels_0;var g=a.xy*vec2u(24u);var h=vec2f(0f);var i:array<vec2f,3>;i[0]=h;i[1]=h;i[2]=h;var j=0u;for(;j<Constants_0.rank_0;){d=c;for(;d<384u;){var k=j+d/24u;var l=d%24u;var m=alpha_0[Constants_0.alpha_offset_0+f*Constants_0.rank_0+min(k,Constants_0.rank_0-1u)];var n=factor_0(Constants_0.h_layout_0,e,k,g.y+l);tileRows_0[d]=m*n;var o=factor_1(Constants_0.w_layout_0,e,k,g.x+l);tileColumns_0[d]=o;d=d+96u;}workgroupBarrier();var p=0u;for(;p<16u;){var q=p*24u;var r=q+b.y;var s=q+2u*b.x;var t=vec2f(tileColumns_0[s],tileColumns_0[s+1u]);var u=0u;for(;u<3u;){i[u]=i[u]+vec2f(tileRows_0[r+u*8u])*t;u=u+1u;}p=p+1u;}workgroupBarrier();j=j+16u;}d=0u;for(;d<3u;){var v=g+vec2u(2u*b.x,b.y+8u*d);var w=v.x;var x=(w<Constants_0.size_0)&&(v.y<Constants_0.size_0);if(x){var y=e*Constants_0.size_0+v.y;var z=storedPair_0(Constants_0.mean_layout_0,neighbours_0(y,w));blended_0[y*rowWords_0(Constants_0.size_0)+w/2u]=packBounded_0(z+i[d]);}d=d+1u;}}`,
};
